"""Snippets of whole declarations. They are generated from the grammar and contain the required parts."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import dropwhile, takewhile

from robbdd_tools.features.layout import lay_out
from robbdd_tools.syntax.grammar import (
    Assignment,
    Choice,
    Expression,
    Literal,
    Optional,
    Pattern,
    Sequence,
    Use,
    read_grammar,
)
from robbdd_tools.syntax.grammar_files import grammar_name, grammar_text
from robbdd_tools.syntax.phrases import PREDICATE_RULE

_CHOSEN: Mapping[str, str] = {
    "Expression": "Fluent",
    "State": "Condition",
    "Condition": f"{PREDICATE_RULE}located_at",
    "Predicate": f"{PREDICATE_RULE}located_at",
    "TimeConstraint": "Before",
    "Value": "ElementRef",
    "Variation": "Product",
    "Assignment": "ValuesAssignment",
    "SetExpression": "ValueList",
    "ImplementationSource": "CatalogEntry",
    "ProviderSource": "GroundTruth",
    "ModelSource": "CatalogEntry",
    "VectorOrNumber": "Number",
    "Variable": "PlainVariable",
}
"""Rules whose most common alternative is not the first one in the grammar, each with this alternative."""
_SHOWN = frozenset({"namespace", "duration", "task", "role", "given", "then", "root"})
"""Optional parts that are shown."""
_RARE = frozenset({"events"})
"""Repeated parts that are not shown, because they have their own snippet."""
_LABELS = frozenset({"Given", "When", "Then", "Scenarios", "variation"})
_SAMPLES: Mapping[str, str] = {
    "NameText": "name",
    "TextLiteral": '"text"',
    "NumberLiteral": "1",
    "QuantityLiteral": "1 m",
    "TableRule": "|---|",
    "ModuleNameText": "module",
}
_OWN_LINES = frozenset({"Action", "VariationPart"})
_INLINE = frozenset({"xyz", "xyzw", "module", "noise", "latency", "update", "update-rate", "type"})
_JOINED = (("holds", "("), ("ns", "="))
_BREAK = "\n"
_MARK = re.compile(r"X(\d+)X")


@dataclass(frozen=True, slots=True)
class Snippet:
    """The snippet of one kind of declaration.

    ``label`` has its first keywords. ``body`` is its text, with placeholders such as ``${1:name}`` and
    ``${2|one,other|}``.
    """

    label: str
    body: str

    @property
    def plain(self) -> str:
        """The body in which each placeholder is replaced by its text, for clients without snippet support."""
        return re.sub(r"\$\{\d+(?::([^}]*)|\|([^,|]*)[^}]*)\}", lambda match: match[1] or match[2] or "", self.body)


_WRITTEN = {
    "NamedPredicate": Snippet(
        "Predicate",
        "Predicate (ns=${1:namespace}) <${2:object}> ${3:is-stored} in <${4:workspace}>: "
        "<${2:object}> is located at <${4:workspace}>",
    )
}
"""Snippets of declarations whose placeholders depend on each other."""


@cache
def declaration_snippets(language: str) -> tuple[Snippet, ...]:
    """Return a snippet for each kind of declaration in a kind of file, in the order of the grammar."""
    rules = read_grammar(grammar_text(language))
    root = rules[f"{grammar_name(language).capitalize()}Declaration"]
    options = root.options if isinstance(root, Choice) else (root,)
    uses = [option for option in options if isinstance(option, Use)]
    return tuple(_WRITTEN.get(option.rule) or _Writer(rules).snippet(option) for option in uses)


@cache
def keyword_form(language: str, words: str) -> str | None:
    """Return the syntax of the form that starts with some keywords.

    If no form starts with them, return the whole form that contains them.
    """
    rules = read_grammar(grammar_text(language))
    wanted = words.split()
    every = [parts for rule in rules.values() for parts in _sequences(rule)]
    for parts in every:
        for start in range(len(parts)):
            literals = [
                part.text
                for part in takewhile(lambda part: _is_word((part,)), parts[start:])
                if isinstance(part, Literal)
            ]
            if literals[: len(wanted)] == wanted and start + len(wanted) <= len(parts):
                return _Writer(rules).form(_up_to_label(parts[start:], len(wanted)))
    around = (parts for parts in every if any(_has_literal(part, words) for part in parts))
    return next((_Writer(rules).form(parts) for parts in around), None)


def _sequences(part: Expression) -> Iterator[tuple[Expression, ...]]:
    """Yield the sequences of parts in a rule, outer ones first."""
    match part:
        case Sequence():
            yield part.parts
            for inner in part.parts:
                yield from _sequences(inner)
        case Choice():
            for option in part.options:
                yield from _sequences(option)
        case Optional():
            yield from _sequences(part.part)
        case Assignment():
            if not isinstance(part.value, Use):
                yield from _sequences(part.value)
            else:
                yield (part,)
        case _:
            yield (part,)


def _up_to_label(parts: tuple[Expression, ...], words: int) -> tuple[Expression, ...]:
    """Return the parts of a form up to the next part that has a label.

    They also end at a closing bracket that was opened before the first part.
    """
    depth = 0
    for number, part in enumerate(parts):
        if part in (Literal("{"), Literal("(")):
            depth += 1
        elif part in (Literal("}"), Literal(")")):
            depth -= 1
        if depth < 0 or (depth == 0 and number > words and _is_labelled(parts, number)):
            return parts[:number]
    return parts


def _is_labelled(parts: tuple[Expression, ...], number: int) -> bool:
    return not _is_word(parts[number - 1 : number]) and _begins_line(parts[number:])


def _has_literal(part: Expression, text: str) -> bool:
    if isinstance(part, Assignment):
        return part.separator == Literal(text) or _has_literal(part.value, text)
    if isinstance(part, Choice):
        return any(_has_literal(option, text) for option in part.options)
    return isinstance(part, Literal) and part.text == text


class _Writer:
    """Writes one declaration with markers for its placeholders. The layout treats these markers as names."""

    def __init__(self, rules: Mapping[str, Expression]) -> None:
        self._rules = rules
        self._placeholders: list[str] = []

    def snippet(self, rule: Use) -> Snippet:
        words = list(dropwhile(lambda word: word == _BREAK, self._words(rule, depth=0)))
        keywords = words[: next(number for number, word in enumerate(words) if not re.fullmatch(r"[^\W\d]+", word))]
        laid_out = lay_out(_broken_into_lines(words)).rstrip("\n")
        return Snippet(" ".join(keywords), _MARK.sub(lambda match: self._placeholders[int(match[1])], laid_out))

    def form(self, parts: tuple[Expression, ...]) -> str:
        """Return parts of a rule as text, in which placeholders are replaced by their texts."""
        words = list(dropwhile(lambda word: word == _BREAK, self._words(Sequence(parts), depth=1)))
        laid_out = lay_out(_broken_into_lines(words)).rstrip("\n")
        body = _MARK.sub(lambda match: self._placeholders[int(match[1])], laid_out)
        return Snippet("", body).plain

    def _words(self, part: Expression, depth: int, name: str = "") -> Iterator[str]:
        match part:
            case Literal():
                yield part.text
            case Pattern():
                yield self._placeholder(name)
            case Use():
                yield from self._rule(part.rule, depth, name)
            case Sequence():
                for position, inner in enumerate(part.parts):
                    if not _is_word(part.parts[position - 1 : position]) and _begins_line(part.parts[position:]):
                        yield _BREAK
                    yield from self._words(inner, depth, name)
            case Choice():
                yield from self._choice(part, depth, name)
            case Optional():
                if not _SHOWN.isdisjoint(_attributes(part.part)):
                    yield from self._words(part.part, depth, name)
            case Assignment():
                if part.operator == "*=" and (part.attribute in _RARE or (depth > 1 and part.attribute != "values")):
                    return
                if part.operator in ("*=", "+=") and part.separator is None:
                    yield _BREAK
                if part.operator != "?=":
                    yield from self._words(part.value, depth, part.attribute)

    def _rule(self, rule: str, depth: int, name: str) -> Iterator[str]:
        if rule in _SAMPLES:
            yield self._placeholder(name, _SAMPLES[rule])
        elif rule.endswith("Path"):
            role = rule.removesuffix("Path")
            yield self._placeholder("variable" if role == "Term" else _in_words(role))
        elif rule in _CHOSEN:
            yield from self._rule(_CHOSEN[rule], depth, name)
        else:
            if rule in _OWN_LINES:
                yield _BREAK
            inner = name if rule in ("Name", "Text", "Number") else rule
            yield from self._words(self._rules[rule], depth + (rule not in ("Name", "Text", "Number")), inner)

    def _choice(self, part: Choice, depth: int, name: str) -> Iterator[str]:
        literals = [option.text for option in part.options if isinstance(option, Literal)]
        if len(literals) == len(part.options):
            self._placeholders.append(f"${{{len(self._placeholders) + 1}|{','.join(literals)}|}}")
            yield f"X{len(self._placeholders) - 1}X"
        else:
            yield from self._words(part.options[0], depth, name)

    def _placeholder(self, name: str, sample: str = "name") -> str:
        text = name if sample == "name" and name not in ("", "text") else sample
        quote = '"' if sample.startswith('"') else ""
        if quote:
            text = name if name != "raw" else "text"
        self._placeholders.append(f"${{{len(self._placeholders) + 1}:{text}}}")
        return f"{quote}X{len(self._placeholders) - 1}X{quote}"


def _attributes(part: Expression) -> set[str]:
    match part:
        case Assignment():
            return {part.attribute}
        case Sequence():
            return {attribute for inner in part.parts for attribute in _attributes(inner)}
        case _:
            return set()


def _in_words(role: str) -> str:
    return re.sub(r"(?<=\w)([A-Z])", r"-\1", role).lower()


def _begins_line(parts: tuple[Expression, ...]) -> bool:
    """Return whether the parts of a rule belong on a new line.

    They do if they start with a label (``base name:``), or if they are a line of a story (``As``, ``I``, ``So``).
    """
    first = parts[0].part if isinstance(parts[0], Optional) else parts[0]
    if isinstance(first, Sequence):
        return _begins_line(first.parts)
    words = [part.text for part in takewhile(lambda part: _is_word((part,)), parts) if isinstance(part, Literal)]
    following = parts[len(words)] if words and len(words) < len(parts) else None
    is_label = following == Literal(":") and words[0] not in _INLINE
    return is_label or words[:1] in (["As"], ["I"], ["So"])


def _is_word(parts: tuple[Expression, ...]) -> bool:
    return bool(parts) and isinstance(parts[0], Literal) and parts[0].text[0].isalpha()


def _broken_into_lines(words: list[str]) -> str:
    """Join words to lines.

    There is a line break after each opening brace and section label, and before each closing brace.
    """
    text = ""
    for number, word in enumerate(words):
        before = words[number - 1] if number else ""
        if word == _BREAK or before == "{" or word == "}" or (before == ":" and words[number - 2] in _LABELS):
            text = text.rstrip() + "\n"
        elif not (before in ("(", "<", "=", "", _BREAK) or word in (")", ">", ":", ",")):
            text += "" if (before, word) in _JOINED else " "
        text += "" if word == _BREAK else word
    return text.replace('="', '= "').replace("=<", "= <")
