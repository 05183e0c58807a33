"""Writes the reference of the language, ``docs/language``: ``.venv/bin/python docs/site/reference.py``.

Each construct has its form and its meaning (``grammar/reference``, as in hover), its rules as text and as diagrams, and
examples from models that the tests check and run, with the Gherkin and the graph that are made of them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from construct_examples import Example, example_of_rule, examples
from construct_output import gherkin, turtle
from language import ROOT, code
from railroad_drawing import LEXICAL, drawing, is_words

from robbdd_tools.catalog.api import Behaviour, Predicate
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.features.sentences import word_meaning
from robbdd_tools.features.study_words import FORMS
from robbdd_tools.syntax import grammar
from robbdd_tools.syntax.constructs import Construct, constructs, literals, read_rules, rules_of, uses
from robbdd_tools.syntax.phrases import ACTION_RULE, PREDICATE_RULE

FOLDER = ROOT / "docs" / "language"
PAGES = {
    "bdd": ("criteria", "Acceptance criteria", "`.bdd` files state what must be true, when, and with which values."),
    "scene": ("scenes", "Scenes", "`.scene` files state what is there: objects, workspaces, agents."),
    "scenex": (
        "executable-scenes",
        "Executable scenes",
        "`.scenex` and `.ktree` files state what a simulation needs: models, poses, distributions, joints.",
    ),
    "bddx": ("executions", "Executions", "`.bddx` files state how scenarios are executed and observed."),
    "base": ("all-files", "Parts of all files", "These forms occur in several kinds of file."),
}
"""The page of each grammar: its name, title and first sentence."""
MADE = """Each section has the form and the meaning that editors show when you hover over a keyword, the rules of the
[grammar](grammar.md) as a railroad diagram and as text, and parts of models that are [checked and run](examples).
[Prefixes](README.md#prefixes) in graphs are those of the vocabulary. `docs/site/reference.py` writes this page.
"""
HIDDEN = ("Predicate", "Condition", "Action")
"""Rules that only list the phrases of the catalog."""
LEXICAL_RULE = re.compile(r"\w+(Ref|Path|Text|Literal)")
RULE = r"((?:^//[^\n]*\n)*)^{}:((?:[^;'/]|'[^']*'|/(?:\\.|[^/\\])+/)*;)"


def files() -> Mapping[Path, str]:
    """Return the texts of all pages and diagrams."""
    found: dict[Path, str] = {FOLDER / "README.md": overview(), FOLDER / "words.md": words_page()}
    found |= studies_pages()
    for source, (name, title, about) in PAGES.items():
        sections = [f"# {title}\n\n{about}\n\n{MADE}"]
        for construct in constructs(source):
            picture = FOLDER / "diagrams" / f"{name}-{slug(construct.title)}.svg"
            shown = shown_rules(construct)
            found[picture] = drawing(shown, _rules(source))
            sections.append("\n".join(section(construct, picture, shown)))
        found[FOLDER / f"{name}.md"] = "\n".join(sections)
    return found


def slug(title: str) -> str:
    """Return a title as a part of a file name or as the anchor of its section."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _language(source: str) -> str:
    return "bdd" if source == "base" else source


def _rules(source: str) -> Mapping[str, grammar.Expression]:
    return read_rules(_language(source))


def shown_rules(construct: Construct) -> list[tuple[str, grammar.Expression]]:
    """Return the rules that are drawn for a construct; for keywords of other rules, the parts that begin with them."""
    rules = _rules(construct.source)
    found = [
        (rule, rules[rule])
        for rule in rules_of(_language(construct.source), construct)
        if rule in construct.rules
        or not (is_words(rules[rule]) or LEXICAL_RULE.fullmatch(rule) or rule in LEXICAL or rule in HIDDEN)
    ]
    if not found:
        for rule, body in rules.items():
            found += [(rule, part) for part in optional_parts(body) if set(literals(part)) & set(construct.words)]
    return found


def optional_parts(expression: grammar.Expression) -> Iterator[grammar.Expression]:
    """Yield the optional parts of a rule."""
    match expression:
        case grammar.Optional(part):
            yield part
        case grammar.Sequence(parts) | grammar.Choice(parts):
            for part in parts:
                yield from optional_parts(part)
        case _:
            pass


def notation(expression: grammar.Expression) -> str:
    """Return an expression as the page of the grammar writes it."""
    match expression:
        case grammar.Literal(text):
            return f"'{text}'"
        case grammar.Pattern(pattern):
            return f"/{pattern}/"
        case grammar.Use(rule):
            return rule
        case grammar.Sequence(parts):
            return " ".join(map(notation, parts))
        case grammar.Choice(options):
            return f"({' | '.join(map(notation, options))})"
        case grammar.Optional(part):
            return f"({notation(part)})?"
        case grammar.Assignment(operator=operator, value=value, separator=separator):
            between = "" if separator is None else f"['{separator.text}']"
            return f"{notation(value)}{operator.rstrip('=')}{between}"


def section(construct: Construct, picture: Path, shown: list[tuple[str, grammar.Expression]]) -> Iterator[str]:
    """Yield the lines of a section."""
    rules = [rule for rule, _ in shown]
    yield from (f"## {construct.title}", "", construct.markdown, "")
    names = ", ".join(dict.fromkeys(rules))
    yield from (f"![Railroad diagram of {names}; the text says the same]({picture.relative_to(FOLDER).as_posix()})", "")
    if construct.rules:
        yield from code("\n".join(rule_text(construct.source, rule) for rule in dict.fromkeys(rules)))
    else:
        yield from ("```text", *(f"{rule}: … {notation(part)} …" for rule, part in shown), "```", "")
    for example in examples(construct):
        yield from shown_example(example)
    if construct.problems:
        yield "Diagnostics: " + ", ".join(f"[`{one}`](../diagnostics/{one}.md)" for one in construct.problems) + ".\n"
    if construct.see:
        yield f"More: [{construct.see.partition('#')[0]}](../{construct.see}).\n"


@cache
def _grammar(name: str) -> str:
    return (ROOT / "grammar" / f"{name}.tx").read_text(encoding="utf-8")


def rule_text(source: str, rule: str) -> str:
    """Return a rule as the grammar has it, with the comment above it."""
    for name in (source, "base"):
        found = re.search(RULE.format(rule), _grammar(name), re.MULTILINE)
        if found is not None:
            return f"{found[1]}{rule}:{found[2]}"
    raise LookupError(f"no rule {rule} for {source}")


def shown_example(example: Example) -> Iterator[str]:
    """Yield an example with what is made of it."""
    place = os.path.relpath(example.path, FOLDER)
    yield from (f"Example, from [{example.path.name}]({Path(place).as_posix()}):", "", "```robbdd", example.text)
    yield from ("```", "")
    steps, graph = gherkin(example), turtle(example)
    if steps:
        yield from ("In Gherkin:", "", "```gherkin", steps, "```", "")
    if graph:
        yield from ("In the graph:", "", "```turtle", graph, "```", "")


def overview() -> str:
    """Return the page that leads to the others."""
    lines = [
        "# The language",
        "",
        "The reference of every construct, made from the grammars that the parser reads.",
        "",
    ]
    lines += ["| page | constructs |", "|---|---|"]
    for source, (name, title, _) in PAGES.items():
        links = ", ".join(f"[{one.title}]({name}.md#{slug(one.title)})" for one in constructs(source))
        lines.append(f"| [{title}]({name}.md) | {links} |")
    lines += ["| [Predicates and behaviours](words.md) | the phrases of clauses and of `When` |"]
    lines += ["| [Studies](studies.md) | the settings of a `.study` |"]
    lines += ["| [Grammar](grammar.md) | all rules and keywords |"]
    lines += ["| [Design](design.md) | why the language is as it is |", ""]
    lines += ["## Prefixes", "", "The prefixes of the vocabulary. A model declares its own namespaces with `ns`.", ""]
    lines += ["| prefix | namespace |", "|---|---|"]
    lines += [f"| `{prefix}` | `{namespace}` |" for prefix, namespace in PREFIXES.items()]
    return "\n".join([*lines, ""])


def words_page() -> str:
    """Return the page of the catalog's predicates and behaviours."""
    catalog = load_catalog()
    lines = ["# Predicates and behaviours", "", "The phrases of the catalog, as they are installed with RobBDD."]
    lines += ["[Packages of yours](../own-words.md) can add others. `docs/site/reference.py` writes this page.", ""]
    lines += [
        "`<…>` is a variable or an element of a scene, `#…` a number with a unit or a variable that has such values, "
        "`$…` a name.",
        "",
    ]
    for title, words in (("Predicates", catalog.predicates), ("Behaviours", catalog.behaviours)):
        lines += [f"## {title}", ""]
        for name in sorted(words):
            lines += word_section(words[name])
    return "\n".join(lines)


def word_section(word: Predicate | Behaviour) -> list[str]:
    """Return the section of a word."""
    slots = ", ".join(f"`{slot.name}` is {'an' if slot.kind[0] in 'aeiou' else 'a'} {slot.kind}" for slot in word.slots)
    about = f": {slots}" if slots else ""
    lines = [f"### {word.name}", "", word_meaning(word), "", f"In Gherkin: `{word.sentence}`{about}.", ""]
    if word.aliases:
        lines += ["Also written " + ", ".join(f"`{alias}`" for alias in word.aliases) + ".", ""]
    prefix = PREDICATE_RULE if isinstance(word, Predicate) else ACTION_RULE
    example = example_of_rule("bdd", prefix + word.name.replace("-", "_"))
    return [*lines, *(shown_example(example) if example is not None else ())]


def studies_pages() -> Mapping[Path, str]:
    """Return the page of studies and its diagrams. A test compares their grammar with the reader of studies."""
    rules = read_rules("study")
    lines = ["# Studies", "", "A `.study` file states what is executed many times, and when to stop."]
    lines += ["[Campaigns](../campaigns.md) explains how to run one. `docs/site/reference.py` writes this page.", ""]
    found: dict[Path, str] = {}
    for name, (form, meaning) in FORMS.items():
        picture = FOLDER / "diagrams" / f"studies-{name.lower()}.svg"
        shown = [(rule, rules[rule]) for rule in _rules_of_setting(rules, name)]
        found[picture] = drawing(shown, rules)
        names = ", ".join(rule for rule, _ in shown)
        lines += [f"## {name}", "", "```text", form, "```", "", meaning, ""]
        lines += [f"![Railroad diagram of {names}; the text says the same](diagrams/{picture.name})", ""]
        lines += code("\n".join(rule_text("study", rule) for rule, _ in shown))
    return {FOLDER / "studies.md": "\n".join(lines), **found}


def _rules_of_setting(rules: Mapping[str, grammar.Expression], word: str) -> list[str]:
    """Return the rule that begins with a word, and the rules that it uses, without those of single tokens."""
    found = [rule for rule, body in rules.items() if next(iter(literals(body)), "") == word and rule != "Import"][:1]
    for rule in found:
        own = rules[rule]
        found += [one for one in uses(own) if one not in (*found, *LEXICAL) and rule != "Study"]
    return found


def write() -> None:
    """Write all pages, and remove diagrams of constructs that no longer exist."""
    written = files()
    for old in (FOLDER / "diagrams").glob("*.svg"):
        if old not in written:
            old.unlink()
    (FOLDER / "diagrams").mkdir(exist_ok=True)
    for path, text in written.items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write()
