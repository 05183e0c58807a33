"""Report elements of a graph's scenes that a run cannot simulate, because they lack a model, a place or room."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.catalog.standard_places import SIDES
from robbdd_tools.checks.graph_site import members, values_of
from robbdd_tools.checks.no_model import CODE as NO_MODEL
from robbdd_tools.checks.no_model import without_model
from robbdd_tools.checks.no_region import CODE as NO_REGION
from robbdd_tools.checks.no_region import not_carried
from robbdd_tools.checks.no_room import CODE as NO_ROOM
from robbdd_tools.checks.no_room import ELSEWHERE, crowded, too_many
from robbdd_tools.graph.acceptance_model import Exists, ForAll, Iri, Product, Selection, every_clause
from robbdd_tools.graph.read.clauses import used_names

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.checks.graph_site import GraphSite
    from robbdd_tools.graph.acceptance_model import Clause, Variant


def scene_findings(site: GraphSite) -> Iterator[Diagnostic]:
    """Report elements without a model, workspaces that nothing carries, and scenes without room."""
    yield from _without_model(site)
    yield from _without_region(site)
    for variant in site.variants:
        if not _instances(site, variant):
            yield from _crowded(site, variant)


def _without_model(site: GraphSite) -> Iterator[Diagnostic]:
    """Report each element once: as a warning if a scenario uses it, otherwise as an information."""
    found: dict[Iri, bool] = {}
    for variant in site.variants:
        instances = _instances(site, variant)
        if any(instance.models for instance in instances):
            continue
        modelled = {one.element for instance in instances for one in instance.elements if one.models}
        used = _used(site, variant)
        for element in _loaded(site, variant):
            if element not in modelled and not _fits(site, element):
                found[element] = found.get(element, False) or element in used
    for element, is_used in found.items():
        message = without_model([site.local_name(element)], {site.model.kinds[element]}, is_used=is_used)
        yield site.finding(element, NO_MODEL, message, Severity.WARNING if is_used else Severity.INFORMATION)


def _without_region(site: GraphSite) -> Iterator[Diagnostic]:
    reported: set[Iri] = set()
    for variant in site.variants:
        for _, cell in values_of(variant):
            for value in members(cell):
                if not isinstance(value, Iri) or site.model.kinds.get(value) != "workspace" or value in reported:
                    continue
                if not _is_carried(variant, value, frozenset()):
                    reported.add(value)
                    message = not_carried(f"the scene of {site.name(variant.iri)}", site.local_name(value))
                    yield site.finding(value, NO_REGION, message)


def _crowded(site: GraphSite, variant: Variant) -> Iterator[Diagnostic]:
    things = {site.local_name(one): one for one in sorted(_loaded(site, variant)) if site.model.kinds[one] == "object"}
    models = {name: model for name, one in things.items() if (model := site.object_model(one)) is not None}
    for error in crowded(models):
        yield site.finding(things[error.name], NO_ROOM, f"{error}{ELSEWHERE}")
    agents = max(map(len, _agents_together(site, variant)), default=0)
    if agents > SIDES:
        yield site.finding(variant.iri, NO_ROOM, too_many(agents))


def _agents_together(site: GraphSite, variant: Variant) -> Iterator[set[Iri]]:
    """Yield sets of agents that a scenario certainly uses together."""
    bounds = (one.in_set for one in every_clause(_clauses(variant)) if isinstance(one, ForAll | Exists))
    always = {agent for bound in bounds for agent in _agents(site, site.model.sets.get(bound, ()))}
    variation = variant.variation
    if not isinstance(variation, Product):
        for row in variation.rows:
            yield always.union(*(_agents(site, members(cell)) for cell in row))
        return
    several: list[set[Iri]] = [set()]
    for choices in variation.choices:
        if isinstance(choices, Selection):
            continue
        if len(choices) == 1:
            always |= _agents(site, members(choices[0]))
        else:
            several += [_agents(site, members(cell)) for cell in choices]
    yield from (always | one for one in several)


def _agents(site: GraphSite, values: tuple[object, ...]) -> set[Iri]:
    return {value for value in values if isinstance(value, Iri) and site.model.kinds.get(value) == "agent"}


def _instances(site: GraphSite, variant: Variant) -> list[SceneInstance]:
    """Return the scene instances in which a variant may run."""
    own = [one for one in site.instances if one.scene in variant.scenes]
    return own + [one.scene for one in site.model.executions if one.variant == variant.iri and one.scene is not None]


def _loaded(site: GraphSite, variant: Variant) -> tuple[Iri, ...]:
    """Return the objects and agents of a variant's scene, and those that its variation adds."""
    scene, kinds = variant.scene, site.model.kinds
    values = [value for _, cell in values_of(variant) for value in members(cell)]
    carriers = [thing for things in scene.carriers.values() for thing in things]
    every = (*scene.objects, *carriers, *scene.agents, *(value for value in values if isinstance(value, Iri)))
    return tuple(dict.fromkeys(one for one in every if kinds.get(one) in ("object", "agent")))


def _used(site: GraphSite, variant: Variant) -> set[Iri]:
    """Return the elements that values and clauses name, with the objects that carry the workspaces among them."""
    values = {value for _, cell in values_of(variant) for value in members(cell) if isinstance(value, Iri)}
    named = {iri for name in used_names(_clauses(variant)) for iri in (name, *site.model.sets.get(name, ()))}
    used = values | {iri for iri in named if isinstance(iri, Iri)}
    waiting = list(used)
    while waiting:
        workspace = waiting.pop()
        inner = {*variant.scene.carriers.get(workspace, ()), *variant.scene.contains.get(workspace, ())} - used
        used |= inner
        waiting += inner
    return used


def _is_carried(variant: Variant, workspace: Iri, seen: frozenset[Iri]) -> bool:
    if workspace in seen:
        return False
    inner = variant.scene.contains.get(workspace, ())
    return workspace in variant.scene.carriers or any(_is_carried(variant, one, seen | {workspace}) for one in inner)


def _fits(site: GraphSite, element: Iri) -> bool:
    is_object = site.model.kinds[element] == "object"
    return (site.object_model(element) if is_object else site.robot_model(element)) is not None


def _clauses(variant: Variant) -> tuple[Clause, ...]:
    return (*variant.template.clauses, *variant.clauses)
