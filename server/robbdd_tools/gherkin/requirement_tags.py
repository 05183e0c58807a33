"""Tags that name the requirements of stories and scenarios."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robbdd_tools.gherkin import text
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Clause, Exists, ForAll, Iri, Junction, Variant


def requirement_tags(model: AcceptanceModel, owners: Iterable[Iri]) -> tuple[str, ...]:
    """Return a tag for each requirement that some nodes verify, without repetitions."""
    found = (requirement for owner in owners for requirement in model.verifies.get(owner, ()))
    return tuple(text.tag("requirement", requirement) for requirement in dict.fromkeys(found))


def variant_tags(model: AcceptanceModel, variant: Variant) -> tuple[str, ...]:
    """Return the tags of the requirements that a variant, its template or their clauses verify."""
    if not model.verifies:
        return ()
    clauses = every_clause((*variant.template.clauses, *variant.clauses))
    return requirement_tags(model, (variant.iri, variant.template.iri, *clauses))


def every_clause(clauses: Iterable[Clause]) -> Iterator[Iri]:
    """Yield the nodes of clauses and of all clauses inside them."""
    for clause in clauses:
        yield clause.iri
        match clause:
            case Junction():
                yield from every_clause(clause.operands)
            case ForAll() | Exists():
                yield from every_clause(clause.clauses)
            case _:
                pass
