"""Infer the types of variables from clauses and values, because the language has no type declarations.

A type is a set of kinds that a variable, or each element of its set, may have. A phrase narrows the type to the kinds
of its slot. If phrases leave the type open, values in variants narrow it further.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.names.elements import Element, Site, element_of, elements_of, site_of, story_sites
from robbdd_tools.names.uses import ANYTHING, Clauses, Kinds, Use, clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_ORDER = ("object", "workspace", "agent", "number", "quantity", "string")


@dataclass(frozen=True, slots=True)
class VariableType:
    """The kinds that a variable may have. If ``is_set`` is true, they are the kinds of each element of its set."""

    kinds: Kinds
    is_set: bool

    @property
    def is_known(self) -> bool:
        """Return whether any phrase or value narrows the type."""
        return bool(self.kinds) and self.kinds != ANYTHING

    def __str__(self) -> str:
        words = kind_words(self.kinds)
        if not self.is_set:
            return words
        return "set of " + " or ".join(f"{word}s" for word in words.split(" or "))


def kind_words(kinds: Kinds) -> str:
    """Return kinds as text, for example ``object or workspace``, or ``anything`` if no kind is excluded."""
    if kinds == ANYTHING:
        return "anything"
    return " or ".join(kind for kind in _ORDER if kind in kinds)


def narrowed(uses: Iterable[Use]) -> Kinds:
    """Return the kinds that all uses allow."""
    return ANYTHING.intersection(*(use.kinds for use in uses))


def variable_of(site: Site, use: Use) -> Definition | None:
    """Return the variable that a use narrows. For the variable of a quantifier, this is the variable of its set."""
    found = site.target(use.bound.in_set if use.bound is not None else use.ref)
    variable = found is not None and found.kind in (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)
    return found if variable else None


def variable_key(definition: Definition) -> str:
    """Return a key that identifies a variable. Templates of one namespace share a variable if its name is the same."""
    return definition.iri or f"{definition.uri} {definition.symbol.path}"


def uses_by_variable(site: Site, clauses: Clauses) -> dict[str, list[Use]]:
    """Return the uses in the clauses of a template or variant, by the key of the variable that they narrow."""
    found: dict[str, list[Use]] = {}
    for use in clauses.uses:
        variable = variable_of(site, use)
        if variable is not None:
            found.setdefault(variable_key(variable), []).append(use)
    return found


Written = tree.Value | tree.Link | tree.ValueList | tree.Selection | tree.SetList


def written_elements(site: Site, written: Written) -> Iterator[tuple[tree.Node, Element]]:
    """Yield each element in a cell or a line, with the syntax node at which to report it."""
    match written:
        case tree.Number() | tree.Quantity() | tree.Text() | tree.Ref():
            element = element_of(site, written)
            if element is not None:
                yield written, element
        case tree.Link():
            for element in elements_of(site.follow(written.reference)) or ():
                yield written.reference, element
        case tree.Selection():
            for element in elements_of(site.follow(written.source)) or ():
                yield written.source, element
        case tree.ValueList():
            for value in written.values:
                yield from written_elements(site, value)
        case tree.SetList():
            for values in written.sets:
                yield from written_elements(site, values)


def columns_of(variation: tree.Table | tree.Product) -> Iterator[tuple[tree.Ref, tuple[Written, ...]]]:
    """Yield the variable and the written values of each column or line of a variation."""
    if isinstance(variation, tree.Product):
        for line in variation.assignments:
            yield line.variable, (line.choices,)
        return
    for index, variable in enumerate(variation.header):
        yield variable, tuple(row.cells[index] for row in variation.rows if index < len(row.cells))


def variable_type(snapshot: Snapshot, definition: Definition, *, from_values: bool = True) -> VariableType:
    """Return the type of a variable, derived from its template and from the known variants.

    If ``from_values`` is false, only the template is used. No value in a variant may violate the resulting type.
    """
    is_set = definition.kind is SymbolKind.SET_VARIABLE
    site = site_of(snapshot, definition)
    owner = None if site is None else _owner(site, definition)
    if site is None:
        return VariableType(ANYTHING, is_set)
    bound = None if owner is None else _bound_uses(site, owner, definition)
    if bound is not None:
        return VariableType(bound, False)
    # A template that is being edited may have no tree; the values in its variants are still known.
    uses = {} if owner is None else uses_by_variable(site, owner)
    kinds = narrowed(uses.get(variable_key(definition), ()))
    if from_values and len(kinds) > 1:
        kinds = _narrowed_by_variants(snapshot, definition, kinds)
    return VariableType(kinds, is_set)


def _owner(site: Site, definition: Definition) -> Clauses | None:
    """Return the clauses of the template or variant that declares a variable."""
    every = clauses_of(site.placed.declaration)
    return next((clauses for clauses in every if site.span(clauses.node).contains(definition.span.start)), None)


def _bound_uses(site: Site, owner: Clauses, definition: Definition) -> Kinds | None:
    """Return the kinds of a quantifier's variable; ``None`` if the variable does not belong to a quantifier."""
    bounds = [bound for bound in owner.bounds if site.span(bound.variable) == definition.span]
    if not bounds:
        return None
    kinds = narrowed(use for use in owner.uses if use.bound == bounds[0])
    elements = elements_of(site.follow(bounds[0].in_set))
    if elements:
        return kinds & {element.kind for element in elements}
    found = site.target(bounds[0].in_set)
    if len(kinds) > 1 and found is not None and found.kind is SymbolKind.SET_VARIABLE:
        return variable_type(site.snapshot, found).kinds
    return kinds


def _narrowed_by_variants(snapshot: Snapshot, definition: Definition, kinds: Kinds) -> Kinds:
    """Return the kinds that both the phrases and the values of all known variants allow."""
    given: set[str] = set()
    key = variable_key(definition)
    for site, variant, clauses in _variants(snapshot, definition):
        kinds &= narrowed(uses_by_variable(site, clauses).get(key, ()))
        for ref, written in columns_of(variant.variation):
            target = site.target(ref)
            if target is not None and variable_key(target) == key:
                given |= {element.kind for cell in written for _, element in written_elements(site, cell)}
    return kinds & given if kinds & given else kinds


def _variants(snapshot: Snapshot, definition: Definition) -> Iterator[tuple[Site, tree.Variant, Clauses]]:
    """Yield the variants of the template that declares a variable.

    They are in the file of the template and in the files that import it.
    """
    template = definition.symbol.path.partition(".")[0]
    for uri in (definition.uri, *snapshot.importers(definition.uri)):
        file = snapshot.file(uri)
        for site in story_sites(snapshot, file) if file is not None else ():
            for clauses in clauses_of(site.placed.declaration):
                variant = clauses.node
                if not isinstance(variant, tree.Variant):
                    continue
                found = site.target(variant.template)
                if found is not None and (found.uri, found.symbol.path) == (definition.uri, template):
                    yield site, variant, clauses
