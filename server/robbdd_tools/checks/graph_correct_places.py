"""Report objects of a graph without a stated correct workspace, if clauses ask for this workspace."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.catalog.phrases_in_text import predicates_in_text
from robbdd_tools.checks.graph_site import members, values_of
from robbdd_tools.checks.no_correct_place import CODE, WORDS, no_place
from robbdd_tools.graph.acceptance_model import Exists, Fluent, ForAll, Iri, TextFluent, every_clause

if TYPE_CHECKING:
    from robbdd_tools.checks.graph_site import GraphSite
    from robbdd_tools.graph.acceptance_model import Condition, Variant


def place_findings(site: GraphSite) -> Iterator[Diagnostic]:
    """Report each such object once."""
    reported: set[Iri] = set()
    for variant in site.variants:
        asked = _asked(variant)
        for variable, cell in values_of(variant) if asked else ():
            for value in members(cell) if variable in asked else ():
                if not isinstance(value, Iri) or value in reported:
                    continue
                if site.model.kinds.get(value) == "object" and value not in site.model.correct_places:
                    reported.add(value)
                    yield site.finding(value, CODE, no_place(site.local_name(value)), Severity.WARNING)


def _asked(variant: Variant) -> frozenset[str]:
    """Return the variables of the objects for which clauses ask whether they are in their correct places."""
    clauses = tuple(every_clause((*variant.template.clauses, *variant.clauses)))
    sets = {clause.variable: clause.in_set for clause in clauses if isinstance(clause, ForAll | Exists)}
    asked: set[str] = set()
    for clause in clauses:
        if isinstance(clause, TextFluent):
            for predicate, named in predicates_in_text(clause.template, clause.arguments):
                placeholders = (named.get(slot, "") for slot in ("object", "objects") if predicate.name in WORDS)
                asked.update(str(clause.arguments[name]) for name in placeholders if name in clause.arguments)
        used: list[Fluent | Condition] = [clause] if isinstance(clause, Fluent) else []
        if isinstance(clause, Fluent | TextFluent):
            used += clause.conditions
        for one in used:
            if one.predicate in WORDS:
                slots = (one.arguments.get("object"), one.arguments.get("objects"))
                asked.update(str(name) for name in slots if name is not None)
    return frozenset(asked | {str(sets[Iri(name)]) for name in asked if name in sets})
