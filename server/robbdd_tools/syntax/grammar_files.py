"""The grammar of each file kind, assembled from the grammar files and the phrases of the catalog."""

from __future__ import annotations

from functools import cache

from robbdd_tools.base.data import data_file
from robbdd_tools.base.files import load_text
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.phrases import phrase_rules

_GRAMMARS = {"ktree": "scenex", "scenario": "bdd"}
"""File kinds, and parts of declarations, that use the grammar of another file kind."""
ROOTS = {"scenario": "ScenarioChunk"}
"""Part of a declaration → its root rule. The root rule of a file kind is the first rule of its grammar."""


@cache
def grammar_text(language: str) -> str:
    """Return the whole grammar of a file kind: its own rules, the shared rules, and the phrases of the catalog."""
    grammars = [load_text(data_file("grammar", f"{name}.tx")) for name in (grammar_name(language), "base")]
    if grammar_name(language) == "bdd":
        grammars.append(phrase_rules(load_catalog()))
    return "\n".join(grammars)


def grammar_name(language: str) -> str:
    """Return the name of the grammar of a file kind."""
    return _GRAMMARS.get(language, language)
