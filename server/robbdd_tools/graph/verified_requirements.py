"""Find the scenarios and clauses that verify each requirement of a graph, and merge those of several graphs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import Clause, ForAll, every_clause

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Story, Variant
    from robbdd_tools.graph.requirement import Requirement


@dataclass(frozen=True, slots=True)
class VerifyingVariant:
    """A scenario variant that verifies a requirement.

    ``clauses`` maps the IRIs of the clauses that verify it to their names. If ``whole`` is true, they are all ``Then``
    clauses, because the variant itself, its story or its template names the requirement. ``scenarios`` is the number of
    its scenarios, if known.
    """

    iri: str
    name: str
    clauses: Mapping[str, str]
    whole: bool
    scenarios: int | None = None


@dataclass(frozen=True, slots=True)
class LinkedRequirement:
    """A requirement with the scenario variants that verify it, in written order."""

    iri: str
    name: str
    identifier: str
    text: str
    source: str
    variants: tuple[VerifyingVariant, ...] = field(default=())


def requirement_links(model: AcceptanceModel) -> tuple[LinkedRequirement, ...]:
    """Return the requirements of a model with their links, in the order of their IRIs."""
    variants: dict[str, list[VerifyingVariant]] = {}
    for story in model.stories if model.requirements else ():
        for variant in story.variants:
            for requirement, found in _verified(model, story, variant):
                variants.setdefault(requirement, []).append(found)
    return tuple(_linked(model, one, variants.get(one.iri, ())) for one in model.requirements)


def counted_links(
    links: Iterable[LinkedRequirement], counts: Mapping[str, int | None]
) -> tuple[LinkedRequirement, ...]:
    """Return requirements with the numbers of scenarios of their variants, by IRI."""
    return tuple(
        replace(one, variants=tuple(replace(variant, scenarios=counts.get(variant.iri)) for variant in one.variants))
        for one in links
    )


def merged_links(several: Iterable[tuple[LinkedRequirement, ...]]) -> tuple[LinkedRequirement, ...]:
    """Merge the requirements of several models. A variant that several models have is listed once."""
    found: dict[str, LinkedRequirement] = {}
    for links in several:
        for one in links:
            known = found.get(one.iri, replace(one, variants=()))
            every = {variant.iri: variant for variant in (*known.variants, *one.variants)}
            found[one.iri] = replace(known, variants=tuple(every.values()))
    return tuple(found[iri] for iri in sorted(found))


def names_by_variant(links: Iterable[LinkedRequirement]) -> dict[str, list[str]]:
    """Map the IRI of each verifying variant to the requirements that it verifies, each by its identifier or name."""
    found: dict[str, list[str]] = {}
    for one in links:
        for variant in one.variants:
            found.setdefault(variant.iri, []).append(one.identifier or one.name)
    return found


def _linked(
    model: AcceptanceModel, requirement: Requirement, variants: Iterable[VerifyingVariant]
) -> LinkedRequirement:
    name = _local(model, requirement.iri)
    identifier = "" if requirement.identifier == name else requirement.identifier
    return LinkedRequirement(requirement.iri, name, identifier, requirement.text, requirement.source, tuple(variants))


def _verified(model: AcceptanceModel, story: Story, variant: Variant) -> Iterator[tuple[str, VerifyingVariant]]:
    """Yield the requirements that a variant verifies, with the clauses that do."""
    judged = list(_judged((*variant.template.clauses, *variant.clauses)))
    owners = (story.iri, variant.iri, variant.template.iri)
    whole = dict.fromkeys(one for owner in owners for one in model.verifies.get(owner, ()))
    named: dict[str, dict[str, str]] = {}
    for clause in judged:
        for part in every_clause([clause]):
            for requirement in model.verifies.get(part.iri, ()):
                named.setdefault(requirement, {})[clause.iri] = _local(model, clause.iri)
    name = f"{_local(model, story.iri)}.{_local(model, variant.iri)}"
    then: dict[str, str] = {one.iri: _local(model, one.iri) for one in judged if getattr(one, "role", "") == "then"}
    for requirement in dict.fromkeys((*whole, *named)):
        clauses: Mapping[str, str] = then if requirement in whole else named[requirement]
        yield requirement, VerifyingVariant(variant.iri, name, clauses, requirement in whole)


def _judged(clauses: Iterable[Clause]) -> Iterator[Clause]:
    """Yield the clauses that are judged by themselves: those in loops, but not the parts of groups."""
    for clause in clauses:
        if isinstance(clause, ForAll):
            yield from _judged(clause.clauses)
        else:
            yield clause


def _local(model: AcceptanceModel, iri: str) -> str:
    return model.curie(iri).rsplit(":", 1)[-1].replace("#", "/").rsplit("/", 1)[-1]
