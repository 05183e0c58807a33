"""Words for the clauses of a study, which stores the names of clauses but not their sentences."""

from __future__ import annotations

import re
from collections.abc import Iterable

_BEHAVIOUR = re.compile(r"when-bhv-(?P<template>[^.]+)\.(?P<inner>.*?)\.?when(?P<number>\d*)")


def clause_words(name: str) -> str:
    """Return words for a clause: its name in the model or, for a behaviour, which has none, its template.

    The name of a behaviour in the graph is made of the name of its template and the path to the behaviour in it.
    """
    found = _BEHAVIOUR.fullmatch(name)
    if found is None:
        return name
    number = f" {found['number']}" if found["number"] else ""
    inner = f" ({found['inner']})" if found["inner"] else ""
    return f"behaviour{number} of {found['template']}{inner}"


def clause_named(text: str, names: Iterable[str]) -> str | None:
    """Return the clause that a user names by its name or its words; ``None`` if there is none."""
    return next((name for name in names if text in (name, clause_words(name))), None)
