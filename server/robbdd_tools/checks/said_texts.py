"""Find the catalog predicates by which the text of a ``pred("…")`` is judged, as far as the values are known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from robbdd_tools.catalog.phrases_in_text import phrase_with, predicates_in_text
from robbdd_tools.names.elements import Site, element_of, elements_of
from robbdd_tools.names.types import variable_type
from robbdd_tools.names.uses import ANYTHING, Kinds, slot_kinds
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate

Value = tree.Ref | tree.Quantity


class Fit(Enum):
    """The share of the known values that a predicate takes: all, some, or unknown if no kinds are known."""

    ALL = "all"
    SOME = "some"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class SaidPhrase:
    """A predicate that may judge a text, its phrase with the values of the clause, and whether these fit."""

    predicate: Predicate
    written: str
    fit: Fit = Fit.UNKNOWN


def said_phrases(site: Site, clause: tree.Fluent | tree.TextClause) -> tuple[SaidPhrase, ...]:
    """Return the predicates by which a clause may be judged; empty if there are none.

    If the words are those of several predicates, these are the predicates that take some of the known values. For a
    single predicate, the values are not looked up.
    """
    if not isinstance(clause, tree.Fluent) or not isinstance(clause.predicate, tree.TextPredicate):
        return ()
    values: dict[str, Value] = {
        one.name.text: one.value
        for one in clause.predicate.arguments
        # No phrase that may be written as a text has a slot for a plain number or a string.
        if isinstance(one.value, tree.Ref | tree.Quantity)
    }
    said = predicates_in_text(clause.predicate.template.value, values)
    if len(said) < 2:
        return tuple(SaidPhrase(predicate, _written(predicate, named, values)) for predicate, named in said)
    kinds = {name: _kinds(site, value) for name, value in values.items()}
    found = ((predicate, named, _fit(predicate, named, kinds)) for predicate, named in said)
    return tuple(
        SaidPhrase(predicate, _written(predicate, named, values), fit)
        for predicate, named, fit in found
        if fit is not None
    )


def _fit(predicate: Predicate, named: Mapping[str, str], kinds: Mapping[str, Kinds]) -> Fit | None:
    """Return which of the known values fit a predicate; ``None`` if no value of a slot fits."""
    taken = [(slot_kinds(predicate.name)[slot], kinds[name]) for slot, name in named.items()]
    if not all(given & accepted for accepted, given in taken):
        return None
    if all(given <= accepted for accepted, given in taken):
        return Fit.ALL
    return Fit.UNKNOWN if any(given == ANYTHING for _, given in taken) else Fit.SOME


def _written(predicate: Predicate, named: Mapping[str, str], values: Mapping[str, Value]) -> str:
    texts = {name: f"<{value.path}>" if isinstance(value, tree.Ref) else value.text for name, value in values.items()}
    return phrase_with(predicate, {slot: texts[name] for slot, name in named.items()})


def _kinds(site: Site, value: Value) -> Kinds:
    """Return the kinds that a value may have in the scenarios of the known variants."""
    element = element_of(site, value)
    if element is not None and element.kind in ANYTHING:
        return frozenset({element.kind})
    found = site.target(value) if isinstance(value, tree.Ref) else None
    if found is None or not isinstance(value, tree.Ref):
        return ANYTHING
    if found.kind in (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE):
        return variable_type(site.snapshot, found).kinds or ANYTHING
    members = elements_of(site.follow(value))
    return frozenset(member.kind for member in members) if members else ANYTHING
