"""Describe named predicates by their definitions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.features.markdown import literal
from robbdd_tools.features.sentences import state_sentence
from robbdd_tools.names.predicate_parameters import taken_by
from robbdd_tools.names.types import kind_words
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.predicate_tree import written_phrase

if TYPE_CHECKING:
    from robbdd_tools.names.elements import Site

MEANING = (
    "The definition is judged at each sample, and the time constraint of a clause applies to the whole. The margin is "
    "that of the predicate that decides, in its unit; the result names it."
)


def describe_predicate(site: Site | None) -> Iterator[str]:
    """Yield the phrase of a named predicate with its definition, the values of its parameters, and how it is judged."""
    if site is None or not isinstance(site.tree, tree.NamedPredicate):
        return
    yield f"> {literal(written_phrase(site.tree))} means: {literal(state_sentence(site.tree.body))}"
    taken = taken_by(site, site.tree)
    known = [f"`{name}`: {kind_words(one.kinds)}" for name, one in taken.items() if one.is_used and one.kinds]
    if known:
        yield ", ".join(known)
    yield MEANING
