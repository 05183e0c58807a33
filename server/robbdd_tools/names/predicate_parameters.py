"""Infer the kinds of the parameters of named predicates from the definitions of these predicates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.elements import Site, site_of
from robbdd_tools.names.uses import ANYTHING, Kinds, slot_kinds
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition

SETS = (Kind.OBJECT_SET, Kind.WORKSPACE_SET)


@dataclass(slots=True)
class Taken:
    """Kinds and dimensions of quantities that a parameter accepts, and whether its slots accept a set as a whole."""

    kinds: Kinds = ANYTHING
    dimensions: set[str] = field(default_factory=set[str])
    as_set: set[bool] = field(default_factory=set[bool])
    is_used: bool = False


def predicate_of(site: Site, use: tree.NamedUse) -> tuple[Site, tree.NamedPredicate] | None:
    """Return the definition of the predicate of a phrase, with its place; ``None`` if it is not known."""
    found = site.follow(use.predicate)
    if found is None or not isinstance(found.tree, tree.NamedPredicate):
        return None
    target = site.target(use.predicate)
    return (found, found.tree) if target is not None and found.span(found.tree.name) == target.span else None


def predicate_at(site: Site, definition: Definition) -> tree.NamedPredicate | None:
    """Return the named predicate that declares a name. The name is its own or the name of a parameter."""
    found = site_of(site.snapshot, definition)
    return found.tree if found is not None and isinstance(found.tree, tree.NamedPredicate) else None


def taken_by(site: Site, predicate: tree.NamedPredicate, inside: tuple[str, ...] = ()) -> Mapping[str, Taken]:
    """Return what each parameter of a predicate accepts. ``inside`` are the predicates that use this predicate."""
    found = {parameter.name.text: Taken() for parameter in predicate.parameters}
    key = _key(site, predicate)
    for ref, given in () if key in inside else _filled(site, predicate, (*inside, key)):
        own = found.get(ref.path.removeprefix(f"{predicate.name.text}."))
        if own is not None:
            own.kinds &= given.kinds
            own.dimensions |= given.dimensions
            own.as_set |= given.as_set
            own.is_used = True
    return found


def _filled(site: Site, predicate: tree.NamedPredicate, inside: tuple[str, ...]) -> Iterator[tuple[tree.Ref, Taken]]:
    """Yield the references in a definition, each with the values that its place accepts."""
    for node in walk(predicate.body):
        if isinstance(node, tree.PhraseUse):
            slots = {slot.name: slot for slot in load_catalog().predicates[node.word].slots}
            for name, value in node.arguments:
                if isinstance(value, tree.Ref):
                    slot = slots[name]
                    dimensions = {slot.dimension} if slot.dimension else set[str]()
                    yield value, Taken(slot_kinds(node.word)[name], dimensions, {slot.kind in SETS})
        elif isinstance(node, tree.NamedUse):
            known = predicate_of(site, node)
            inner = [] if known is None else list(taken_by(*known, inside).values())
            for value, given in zip(node.values, inner, strict=False):
                if isinstance(value, tree.Ref):
                    yield value, given


def leads_back(site: Site, predicate: tree.NamedPredicate, use: tree.NamedUse) -> bool:
    """Return whether a phrase's predicate is ``predicate``, or its definition uses that one, directly or indirectly."""
    goal, seen = _key(site, predicate), set[str]()
    waiting = [predicate_of(site, use)]
    while waiting:
        known = waiting.pop()
        if known is None:
            continue
        key = _key(*known)
        if key == goal:
            return True
        if key not in seen:
            seen.add(key)
            waiting += [predicate_of(known[0], one) for one in walk(known[1].body) if isinstance(one, tree.NamedUse)]
    return False


def _key(site: Site, predicate: tree.NamedPredicate) -> str:
    return f"{site.uri} {predicate.name.text}"
