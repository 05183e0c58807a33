"""A scenario variant together with its template, as most rules about variants need it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.names.types import columns_of, variable_key
from robbdd_tools.names.uses import Clauses, clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.types import Written

VARIABLES = (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)


@dataclass(frozen=True, slots=True)
class Column:
    """What a variation writes for one variable; ``variable`` is ``None`` for an unknown name."""

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
        """Return the variables of the template by their keys, in the order of the text."""
        site = self.template
        root = None if site is None else site.tree
        if site is None or not isinstance(root, tree.Template):
            return {}
        paths = (f"{root.name.text}.{variable.name.text}" for variable in root.variables)
        found = (site.file.definitions.get(path) for path in paths)
        return {variable_key(variable): variable for variable in found if variable is not None}


@lru_cache(maxsize=2)
def scenarios(site: Site) -> tuple[Scenario, ...]:
    """Return the variants of a story that have no syntax error; every rule asks for the same ones in turn."""
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
