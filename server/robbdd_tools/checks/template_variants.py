"""A scenario variant together with its template. Most rules about variants use both."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.names.elements import scene_members
from robbdd_tools.names.types import columns_of, variable_key, variable_type
from robbdd_tools.names.uses import ELEMENTS, Clauses, clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Element, Site
    from robbdd_tools.names.types import Written
    from robbdd_tools.names.uses import Kinds

VARIABLES = (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)


@dataclass(frozen=True, slots=True)
class Column:
    """The values of one variable in a variation. ``variable`` is ``None`` if its name is unknown."""

    ref: tree.Ref
    variable: Definition | None
    written: tuple[Written, ...]


@dataclass(frozen=True, slots=True)
class Scenario:
    """A variant of a story; ``template`` is ``None`` while it is unknown or has syntax errors."""

    site: Site
    variant: tree.Variant
    clauses: Clauses
    template: Site | None
    columns: tuple[Column, ...]

    @property
    def outer(self) -> Clauses | None:
        """The clauses of the template."""
        return None if self.template is None else clauses_of(self.template.placed.declaration)[0]

    def declared(self) -> dict[str, Definition]:
        """Return the variables of the template by their keys, in text order."""
        site = self.template
        root = None if site is None else site.tree
        if site is None or not isinstance(root, tree.Template):
            return {}
        paths = (f"{root.name.text}.{variable.name.text}" for variable in root.variables)
        found = (site.file.definitions.get(path) for path in paths)
        return {variable_key(variable): variable for variable in found if variable is not None}

    def members(self, kinds: Kinds) -> list[Element]:
        """Return the members of the scene that are of some kinds, sorted; empty while the scene is unknown."""
        found = scene_members(self.site.follow(self.variant.scene)) or frozenset()
        return sorted((member for member in found if member.kind in kinds), key=lambda member: member.key)

    def fitting_for(self, variable: Definition) -> list[str]:
        """Return the values in the scene that all phrases with a template variable accept."""
        kinds = variable_type(self.site.snapshot, variable, from_values=False).kinds & ELEMENTS
        return [f"<{member.name}>" for member in self.members(kinds)]

    def cell_for(self, variable: Definition) -> str | None:
        """Return a cell with the first matching value of the scene or, for a set variable, with all matching values."""
        values = self.fitting_for(variable)
        if not values:
            return None
        return f"{{ {', '.join(values)} }}" if variable.kind is SymbolKind.SET_VARIABLE else values[0]


@lru_cache(maxsize=2)
def scenarios(site: Site) -> tuple[Scenario, ...]:
    """Return the variants of a story without syntax errors. They are cached, because every rule needs them."""
    every = clauses_of(site.placed.declaration)
    variants = [(entry.node, entry) for entry in every if isinstance(entry.node, tree.Variant)]
    return tuple(_scenario(site, variant, clauses) for variant, clauses in variants if site.whole(variant))


def _scenario(site: Site, variant: tree.Variant, clauses: Clauses) -> Scenario:
    columns = tuple(Column(ref, site.target(ref), written) for ref, written in columns_of(variant.variation))
    return Scenario(site, variant, clauses, _template(site, variant), columns)


def _template(site: Site, variant: tree.Variant) -> Site | None:
    template = site.follow(variant.template)
    if template is None or not isinstance(template.tree, tree.Template) or not template.whole(template.tree):
        return None
    return template
