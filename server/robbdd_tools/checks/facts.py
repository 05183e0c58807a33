"""Collect the data that the rules need about a single declaration, once per declaration."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.names.uses import Bound, Clauses, clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.move import moved_node, moved_ref

if TYPE_CHECKING:
    from robbdd_tools.syntax.declaration import Declaration

UNIQUE_KINDS = frozenset(
    {
        SymbolKind.EVENT,
        SymbolKind.TASK,
        SymbolKind.REQUIREMENT,
        SymbolKind.OBJECT,
        SymbolKind.WORKSPACE,
        SymbolKind.AGENT,
        SymbolKind.OBJECT_SET,
        SymbolKind.WORKSPACE_SET,
        SymbolKind.AGENT_SET,
        SymbolKind.CONSTANT_SET,
        SymbolKind.PREDICATE,
        SymbolKind.COMPOSITION,
        SymbolKind.SCENE,
        SymbolKind.TEMPLATE,
        SymbolKind.FLUENT,
        SymbolKind.STORY,
        SymbolKind.VARIANT,
    }
)
"""Kinds that need unique IRIs. Variables and behaviours do not, because related scenarios share them by name."""
_REFERRED = re.compile(r"(?:<\s*|\bns\s*=\s*)([^\W\d][\w\-]*)")


@dataclass(frozen=True, slots=True)
class Facts:
    """Names in a declaration.

    They do not depend on the targets of references, so they stay valid wherever the declaration is moved.

    - ``own_names``: the names that it declares and that need unique IRIs, by namespace.
    - ``heads``: the first parts of all names to which it refers.
    - ``clause_paths``: the names of variables in its clauses, as written.
    - ``unused``: the variables of a template that neither a clause nor a quantifier of the template uses.
    - ``unused_bounds``: the variables of quantifiers that no clause uses.
    """

    own_names: Mapping[str, tuple[str, ...]]
    heads: frozenset[str]
    clause_paths: frozenset[str]
    unused: tuple[tree.Variable, ...]
    unused_bounds: tuple[Bound, ...]


@kept_with_key
def facts_of(declaration: Declaration) -> Facts:
    """Return the facts of a declaration."""
    checkpoint()
    if declaration.parts:
        return _put_together(declaration)
    root = declaration.tree
    heads = frozenset(reference.ref.path.partition(".")[0] for reference in declaration.references)
    if declaration.faults:
        # The text that the parser skipped may use names, too.
        heads |= frozenset(_REFERRED.findall(declaration.text))
    names = _own_names(declaration)
    clauses = clauses_of(declaration)
    bounds = tuple(bound for entry in clauses for bound in _unused_bounds(entry))
    unused = _unused(declaration, root) if isinstance(root, tree.Template) else ()
    return Facts(names, heads, _clause_paths(clauses), unused, bounds)


def _put_together(declaration: Declaration) -> Facts:
    """Combine the facts of a declaration's parts."""
    parts = [facts_of(part.declaration) for part in declaration.parts]
    names: dict[str, list[str]] = {}
    for part in parts:
        for namespace, found in part.own_names.items():
            names.setdefault(namespace, []).extend(found)
    bounds = tuple(
        Bound(moved_node(bound.variable, placed.offset), moved_ref(bound.in_set, placed.offset))
        for placed, part in zip(declaration.parts, parts, strict=True)
        for bound in part.unused_bounds
    )
    return Facts(
        {namespace: tuple(found) for namespace, found in names.items()},
        frozenset[str]().union(*(part.heads for part in parts)),
        frozenset[str]().union(*(part.clause_paths for part in parts)),
        (),
        bounds,
    )


def _own_names(declaration: Declaration) -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for symbol in declaration.symbols:
        if symbol.namespace is not None and symbol.kind in UNIQUE_KINDS:
            found.setdefault(symbol.namespace, []).append(symbol.name)
    return {namespace: tuple(names) for namespace, names in found.items()}


def _unused(declaration: Declaration, template: tree.Template) -> tuple[tree.Variable, ...]:
    if declaration.faults:
        return ()
    prefix = f"{template.name.text}."
    used = {reference.ref.path.removeprefix(prefix) for reference in declaration.references}
    return tuple(variable for variable in template.variables if variable.name.text not in used)


def _unused_bounds(clauses: Clauses) -> tuple[Bound, ...]:
    used = {use.bound for use in clauses.uses} if clauses.bounds else set[Bound | None]()
    return tuple(bound for bound in clauses.bounds if bound not in used)


def _clause_paths(clauses: tuple[Clauses, ...]) -> frozenset[str]:
    found: set[str] = set()
    for entry in clauses:
        found.update(use.ref.path for use in entry.uses)
        found.update(bound.in_set.path for bound in entry.bounds)
    return frozenset(found)
