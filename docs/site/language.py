"""Writes ``docs/language/grammar.md`` from the grammars: ``.venv/bin/python docs/site/language.py``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.phrases import phrase_rules

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "language" / "grammar.md"
HEAD = """# Grammar

All rules and words of the language, written by `docs/site/language.py` from the grammars that the parser reads.

`'word'` is written as it stands, `A | B` is a choice, `A?` may be left out, `A*` and `A+` are repeated. A text in
brackets stands between the repetitions: `A+[',']`, `A+['and']`. `/…/` is a regular expression.
"""
KINDS = {
    "bdd": "Acceptance criteria (`.bdd`)",
    "scene": "Scenes (`.scene`)",
    "scenex": "Executable scenes and kinematics (`.scenex`, `.ktree`)",
    "bddx": "Executions (`.bddx`)",
}
RULE = re.compile(r"^(\w+):(?:[^;'/]|'[^']*'|/(?:\\.|[^/\\])+/)*;", re.MULTILINE)
ATTRIBUTE = re.compile(r"\b\w+[*+?]?=")
REPEATED = re.compile(r"\b\w+([*+?])=(\w+|'[^']*')")
WORD = re.compile(r"'([^\W\d][^']*)'")


def page() -> str:
    """Return the text of the page."""
    sections = [HEAD]
    for kind, title in KINDS.items():
        text = (ROOT / "grammar" / f"{kind}.tx").read_text(encoding="utf-8")
        sections.append("\n".join([f"## {title}", "", *code(text), *words(text)]))
    phrases = phrase_rules(load_catalog())
    sections.append("\n".join(["## Phrases of predicates and behaviours", "", *code(phrases)]))
    base = (ROOT / "grammar" / "base.tx").read_text(encoding="utf-8")
    sections.append("\n".join(["## Rules of all files", "", *code(base)]))
    return "\n".join(sections)


def code(grammar: str) -> Iterator[str]:
    """Yield the rules of a grammar without the names of attributes, which only the program uses."""
    lines: list[str] = []
    for line in grammar.strip().splitlines():
        comment = line.startswith("//")
        lines.append(line if comment else ATTRIBUTE.sub("", REPEATED.sub(r"\2\1", line)))
    yield from ("```text", *lines, "```", "")


def words(grammar: str) -> Iterator[str]:
    """Yield a table of a grammar's words, with the rules that have them."""
    rules: dict[str, list[str]] = {}
    for rule in RULE.finditer(grammar):
        for word in WORD.findall(rule[0]):
            rules.setdefault(word, []).append(rule[1])
    yield from ("| word | rules |", "|---|---|")
    for word in sorted(rules, key=lambda one: (one.lower(), one)):
        names = ", ".join(f"`{name}`" for name in dict.fromkeys(rules[word]))
        yield f"| `{word}` | {names} |"
    yield ""


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
