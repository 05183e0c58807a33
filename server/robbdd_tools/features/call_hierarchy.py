"""Call hierarchy: a user story calls its variants, a variant its template, and a template its behaviours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.describe import variants_of
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.names.elements import site_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_CALLABLE = (SymbolKind.STORY, SymbolKind.VARIANT, SymbolKind.TEMPLATE, SymbolKind.BEHAVIOUR)


@dataclass(frozen=True, slots=True)
class Call:
    """One entry of a call hierarchy: the caller or the called declaration, and the places of the calls.

    The places are absolute positions in the document of the caller.
    """

    other: Definition
    spans: tuple[Span, ...]


def callable_at(snapshot: Snapshot, uri: str, offset: int) -> Definition | None:
    """Return the story, variant, template or behaviour at an offset."""
    found = symbol_at(snapshot, uri, offset)
    return found[1] if found is not None and found[1].kind in _CALLABLE else None


def calls_from(snapshot: Snapshot, definition: Definition) -> list[Call]:
    """Return the declarations that a story, variant or template calls, in text order."""
    match definition.kind:
        case SymbolKind.STORY:
            return [Call(part, (part.span,)) for part in _parts(snapshot, definition, SymbolKind.VARIANT)]
        case SymbolKind.TEMPLATE:
            return [Call(part, (part.span,)) for part in _parts(snapshot, definition, SymbolKind.BEHAVIOUR)]
        case SymbolKind.VARIANT:
            return _template(snapshot, definition)
        case _:
            return []


def calls_to(snapshot: Snapshot, definition: Definition) -> list[Call]:
    """Return the callers of a variant, template or behaviour, file by file in text order."""
    match definition.kind:
        case SymbolKind.BEHAVIOUR | SymbolKind.VARIANT:
            owner = _owner(snapshot, definition)
            return [] if owner is None else [Call(owner, (definition.span,))]
        case SymbolKind.TEMPLATE:
            calls: list[Call] = []
            for scenario in variants_of(snapshot, definition):
                site = scenario.site
                user = site.file.definitions.get(scenario.clauses.path)
                if user is not None:
                    calls.append(Call(user, (site.span(scenario.variant.template),)))
            return calls
        case _:
            return []


def _parts(snapshot: Snapshot, definition: Definition, kind: SymbolKind) -> list[Definition]:
    file = snapshot.file(definition.uri)
    found = file.definitions.values() if file is not None else ()
    return [part for part in found if part.kind is kind and part.symbol.path.startswith(f"{definition.symbol.path}.")]


def _owner(snapshot: Snapshot, definition: Definition) -> Definition | None:
    file = snapshot.file(definition.uri)
    return None if file is None else file.definitions.get(definition.symbol.path.partition(".")[0])


def _template(snapshot: Snapshot, definition: Definition) -> list[Call]:
    site = site_of(snapshot, definition)
    root = None if site is None else site.tree
    if site is None or not isinstance(root, tree.Story):
        return []
    variants = (variant for variant in root.variants if site.span(variant.name) == definition.span)
    found = ((site.target(variant.template), site.span(variant.template)) for variant in variants)
    return [Call(target, (span,)) for target, span in found if target is not None]
