"""The words of names, and which parts of an object a workspace means by its name."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel, Region

_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_SPACE = ("workspace", "ws")
"""Last words of a workspace's name that distinguish it from nothing."""
_SHORTEST = 3
"""A shorter name counts only as a whole word."""


def words_of(name: str) -> list[str]:
    """Return the words and numbers of a name in lower case: ``slotB2`` is slot, b, 2."""
    return re.findall(r"[^\W\d_]+|\d+", _HUMP.sub(" ", name).lower())


def is_named(site: str, workspace: str) -> bool:
    """Return whether a site has the name of a workspace, whatever its case, separators and the word *workspace*."""
    first, second = (_without_space(words_of(name)) for name in (site, workspace))
    return first == second != []


def parts_named(parts: Sequence[str], workspace: str) -> frozenset[str]:
    """Return those names of an object's parts that the name of a workspace contains.

    Whole words take precedence: slot-10 is not slot-1. Of two such names, the longer one counts if it contains the
    other: upper-left is not upper.
    """
    whole = words_of(workspace)
    found = {part: words for part in parts if _is_run(words := words_of(part), whole)}
    if not found:
        joined = "".join(whole)
        return frozenset(part for part in parts if _is_piece("".join(words_of(part)), joined))
    return frozenset(
        part
        for part, words in found.items()
        if not any(other != words and _is_run(words, other) for other in found.values())
    )


def spaces_of(model: ObjectModel, workspace: str) -> tuple[Region, ...]:
    """Return the regions of a workspace: the parts that its name contains, else the part without a name.

    Without either, these are all parts, or the only region.
    """
    names = parts_named([part.name for part in model.parts], workspace)
    named = tuple(part for part in model.parts if part.name in names)
    unnamed = tuple(part for part in model.parts if not part.name)
    return named or unnamed or model.parts or (() if model.region is None else (model.region,))


def _without_space(words: list[str]) -> list[str]:
    return words[:-1] if words and words[-1] in _SPACE else words


def _is_run(words: Sequence[str], whole: Sequence[str]) -> bool:
    """Return whether words follow one another in others."""
    return bool(words) and any(whole[at : at + len(words)] == words for at in range(len(whole)))


def _is_piece(text: str, whole: str) -> bool:
    """Return whether a text is in another one, without cutting a number."""
    end = "(?![0-9])" if text[-1:].isdigit() else ""
    return len(text) >= _SHORTEST and re.search(re.escape(text) + end, whole) is not None
