"""The constructs of the language with their forms and meanings. Hover and the reference show the same texts.

The texts are in ``grammar/reference``, one file for each grammar. A section names the rules of a construct, and its
keywords, either in all rules (``'word'``) or in one rule (``'Rule.word'``). A rule that no section names belongs to the
construct that uses the rule, so an addition to the grammar is described without a change here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from robbdd_tools.base.data import data_file
from robbdd_tools.base.files import load_text
from robbdd_tools.syntax import grammar
from robbdd_tools.syntax.grammar_files import grammar_name, grammar_text
from robbdd_tools.syntax.phrases import word_of_rule

_SECTION = re.compile(
    r"## (?P<title>.+)\n\n(?P<parts>`.+)\n\n```robbdd\n(?P<form>[^`]+)\n```\n\n(?P<meaning>(?s:.*?))"
    r"(?:\nProblems: (?P<problems>.+))?(?:\nSee: (?P<see>.+))?"
)
_PART = re.compile(r"`('?)([^`']+)'?`")


@dataclass(frozen=True, slots=True)
class Construct:
    """A construct of the language.

    - ``source``: the name of its grammar. It is ``base`` for constructs of all files.
    - ``rules`` and ``words``: the rules and the keywords that its section names.
    - ``form``: how it is written, with ``…`` and names in capitals.
    - ``meaning``: what it means, in Markdown.
    - ``problems``: the codes of its diagnostics.
    - ``see``: a page of the documentation with more about it; may be empty.
    """

    title: str
    source: str
    rules: tuple[str, ...]
    words: tuple[str, ...]
    form: str
    meaning: str
    problems: tuple[str, ...]
    see: str

    @property
    def markdown(self) -> str:
        """The text that hover shows for the construct."""
        return f"```robbdd\n{self.form}\n```\n\n{self.meaning}"


@cache
def constructs(source: str) -> tuple[Construct, ...]:
    """Return the constructs of one grammar, in the order of its reference."""
    _, *sections = re.split(r"^(?=## )", load_text(data_file("grammar", f"reference/{source}.md")), flags=re.MULTILINE)
    return tuple(_construct(source, section.strip()) for section in sections)


def _construct(source: str, section: str) -> Construct:
    found = _SECTION.fullmatch(section)
    if found is None:
        raise ValueError(f"grammar/reference/{source}.md: a section is not as expected: {section.splitlines()[0]}")
    parts = _PART.findall(found["parts"])
    rules = tuple(name for quote, name in parts if not quote)
    words = tuple(name for quote, name in parts if quote)
    problems = tuple(found["problems"].split(", ")) if found["problems"] else ()
    meaning = found["meaning"].strip()
    return Construct(found["title"], source, rules, words, found["form"], meaning, problems, found["see"] or "")


def construct_of(language: str, rule: str, word: str) -> Construct | None:
    """Return the construct of a keyword in a rule, or ``None`` if nothing describes it."""
    words, owners = _owners(grammar_name(language))
    return words.get(f"{rule}.{word}") or words.get(word) or owners.get(rule)


def constructs_with(language: str, word: str) -> list[Construct]:
    """Return the constructs in which a keyword occurs."""
    having = (rule for rule, body in read_rules(grammar_name(language)).items() if word in literals(body))
    found = (construct_of(language, rule, word) for rule in having)
    return list(dict.fromkeys(one for one in found if one is not None))


def rules_of(language: str, construct: Construct) -> list[str]:
    """Return all rules of a construct: first the rules that it names, then the unnamed rules that these use."""
    owners = _owners(grammar_name(language))[1]
    unnamed = (rule for rule, owner in owners.items() if owner is construct and rule not in construct.rules)
    return [*construct.rules, *unnamed]


@cache
def read_rules(language: str) -> Mapping[str, grammar.Expression]:
    """Return the rules of a kind of file, including shared rules and the rules of catalog phrases."""
    return grammar.read_grammar(grammar_text(language))


@cache
def _owners(name: str) -> tuple[Mapping[str, Construct], Mapping[str, Construct]]:
    """Return the construct of each keyword that a section names, and the construct of each rule that belongs to one."""
    rules = read_rules(name)
    described = (*constructs(name), *constructs("base"))
    words = {word: one for one in reversed(described) for word in one.words}
    named = {rule: one for one in reversed(described) for rule in one.rules if rule in rules}
    owners = {rule: one for one in described for rule in one.rules if rule in rules}
    for construct in described:
        waiting = [rule for rule in construct.rules if rule in rules]
        while waiting:
            for used in uses(rules[waiting.pop(0)]):
                if used not in owners and used not in named and word_of_rule(used) is None:
                    owners[used] = construct
                    waiting.append(used)
    return words, owners


def uses(expression: grammar.Expression) -> Iterator[str]:
    """Yield the names of the rules that an expression uses, in written order."""
    match expression:
        case grammar.Use(rule):
            yield rule
        case grammar.Sequence(parts) | grammar.Choice(parts):
            for part in parts:
                yield from uses(part)
        case grammar.Optional(part):
            yield from uses(part)
        case grammar.Assignment(value=value):
            yield from uses(value)
        case grammar.Literal() | grammar.Pattern():
            pass


def literals(expression: grammar.Expression) -> Iterator[str]:
    """Yield the keywords and symbols in an expression itself, but not those in rules that it uses."""
    match expression:
        case grammar.Literal(text):
            yield text
        case grammar.Sequence(parts) | grammar.Choice(parts):
            for part in parts:
                yield from literals(part)
        case grammar.Optional(part):
            yield from literals(part)
        case grammar.Assignment(value=value, separator=separator):
            yield from literals(value)
            if separator is not None:
                yield separator.text
        case grammar.Use() | grammar.Pattern():
            pass
