"""Remove the shape findings that repeat the diagnostic of a rule."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.read.variable_roles import value_shape

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Span

SUPERSEDED = {
    "duplicate-iri": ("duplicate-iri",),
    "empty-duration": ("shacl-empty-duration",),
    "empty-set": ("shacl-set-elements", "shacl-variable-empty"),
    "foreign-variable": ("shacl-variable-foreign",),
    "missing-value": ("shacl-variable-missing",),
    "repeated-value": ("shacl-variable-repeated",),
    "row-width": ("shacl-row-width",),
    "selection-size": ("shacl-selection-size", "shacl-selection-length"),
    "type-conflict": (
        "shacl-object-value",
        "shacl-workspace-value",
        "shacl-agent-value",
        "shacl-element-value",
        "shacl-horizon-number",
    ),
}
"""Code of a rule → codes of the shapes, other than those of quantities, that report the same mistake."""


def without_superseded(shapes: Iterable[Diagnostic], fast: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Remove the shape findings at places where a rule already reports the same mistake.

    All other findings stay, so no mistake is lost where shapes and rules differ.
    """
    reported: dict[tuple[str, str], list[Span]] = {}
    for finding in fast:
        for code in (*SUPERSEDED.get(finding.code, ()), *_quantity_shapes(finding.code)):
            for uri, span in ((finding.uri, finding.span), *((place.uri, place.span) for place in finding.related)):
                reported.setdefault((uri, code), []).append(span)
    return [shape for shape in shapes if not _is_reported(shape, reported.get((shape.uri, shape.code), []))]


@cache
def role_shapes() -> frozenset[str]:
    """Return the codes of the shapes that report values of a kind that the clauses of their variable do not accept."""
    return frozenset((*SUPERSEDED["type-conflict"], *_quantity_shapes("type-conflict")))


@cache
def _quantity_shapes(rule: str) -> tuple[str, ...]:
    """Return the codes of the shapes of quantities that report the same mistake as a rule."""
    words = load_catalog().predicates.values()
    slots = [(word, slot) for word in words for slot in word.slots if slot.kind is Kind.QUANTITY]
    values = tuple(f"shacl-{value_shape(slot.dimension)}" for _, slot in slots)
    if rule == "quantity":
        return (*values, *(f"shacl-{word.name}-{slot.name}" for word, slot in slots))
    return values if rule == "type-conflict" else ()


def _is_reported(shape: Diagnostic, spans: list[Span]) -> bool:
    return any(shape.span.start <= span.end and span.start <= shape.span.end for span in spans)
