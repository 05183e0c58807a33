"""``no-room``: there are too many agents or containers for the table of a scene without a ``.scenex``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.standard_places import SIDES, NoRoom, at_places
from robbdd_tools.checks.chosen_elements import written_elements
from robbdd_tools.checks.finding import finding
from robbdd_tools.checks.no_model import place_of, scene_instances
from robbdd_tools.checks.scene_use import used_elements
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import Site, elements_of, scene_members, story_sites
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.elements import Element
    from robbdd_tools.names.project import Snapshot

CODE = "no-room"
ELSEWHERE = ": place the scene in a .scenex, or leave some out"
"""End of a message: the ways to make room."""
Names = frozenset[str]


def no_room(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report the first container of a scene that has no standard place, and scenarios with too many agents."""
    for placed in file.of(tree.Scene):
        scene = Site(snapshot, file, placed)
        if isinstance(scene.tree, tree.Scene) and used_elements(scene) and not any(scene_instances(scene)):
            yield from _containers(scene)
    # Such a scenario needs more than SIDES agents in the scope of the file. In a large scope, they are not counted.
    scope = snapshot.scope(file.document.uri)
    if not scope.is_small or sum(len(one.names.of_kind.get(SymbolKind.AGENT, ())) for one in scope.nearest) > SIDES:
        for site in story_sites(snapshot, file):
            yield from _too_many_agents(site)


def _containers(scene: Site) -> Iterator[Diagnostic]:
    catalog = load_catalog()
    elements: dict[str, Element] = {}
    for element in sorted(scene_members(scene) or (), key=lambda one: one.key):
        if element.kind == "object":
            elements.setdefault(element.name.rpartition(".")[2], element)
    found = {name: catalog.object_for(name, one.name.split(".")[:-1]) for name, one in elements.items()}
    for error in crowded({name: model for name, model in found.items() if model is not None}):
        yield Diagnostic(
            scene.uri, place_of(scene, elements[error.name]), Severity.WARNING, CODE, f"{error}{ELSEWHERE}"
        )


def crowded(models: Mapping[str, ObjectModel]) -> Iterator[NoRoom]:
    """Yield the first table, and the first container on the table, for which there is no room."""
    tables = [name for name, model in models.items() if not model.free and not model.bystander]
    bystanders = [name for name, model in models.items() if model.bystander]
    standing = [name for name, model in models.items() if model.free and not model.graspable]
    # If there are several tables, compositions assign objects to them, and only a run checks the room.
    on_table = [(standing, tables[0] if tables else "the table")] if len(tables) < 2 else []
    groups = [(tables, "the room"), (bystanders, "the room"), *on_table]
    for names, where in groups:
        try:
            list(at_places(models, names, where))
        except NoRoom as error:
            yield error


def _too_many_agents(site: Site) -> Iterator[Diagnostic]:
    """Report each scenario that uses more agents than a table has sides."""
    for scenario in scenarios(site):
        scene = site.follow(scenario.variant.scene)
        if scene is None or any(scene_instances(scene)):
            continue
        agents = max(map(len, _agents(scenario)), default=0)
        if agents > SIDES:
            yield finding(site, scenario.variant.scene, Severity.WARNING, CODE, too_many(agents))


def too_many(agents: int) -> str:
    """Return the message on a scenario with more agents than a table has sides."""
    return (
        f"this scenario uses {agents} agents, but there is room for {SIDES}, one at each side of the table: "
        "place the others in a .scenex"
    )


def _agents(scenario: Scenario) -> Iterator[Names]:
    """Yield sets of agents that a scenario certainly uses together. Its executions may use more."""
    site, variation = scenario.site, scenario.variant.variation
    quantified = frozenset(chain.from_iterable(_quantified(scenario)))
    if isinstance(variation, tree.Table):
        for row in variation.rows:
            cells = (written_elements(site, cell) for cell in row.cells)
            yield quantified | _names(element for cell in cells for _, element in cell)
        return
    fixed = quantified
    choices: list[Names] = [frozenset()]
    for line in variation.assignments:
        match line.choices:
            case tree.SetList(sets=sets):
                choices += [_names(element for _, element in written_elements(site, one)) for one in sets]
            case tree.ValueList(values=(only,)):
                fixed |= _names(element for _, element in written_elements(site, only))
            case _:
                pass
    yield from (fixed | choice for choice in choices)


def _quantified(scenario: Scenario) -> Iterator[Names]:
    """Yield the agents in the sets that the quantifiers of clauses name."""
    places = [(scenario.site, scenario.clauses)]
    if scenario.template is not None and scenario.outer is not None:
        places.append((scenario.template, scenario.outer))
    for site, clauses in places:
        for bound in clauses.bounds:
            yield _names(elements_of(site.follow(bound.in_set)) or ())


def _names(elements: Iterator[Element] | tuple[Element, ...]) -> Names:
    return frozenset(element.name for element in elements if element.kind == "agent" and not _is_bystander(element))


def _is_bystander(element: Element) -> bool:
    *sets, name = element.name.split(".")
    catalog = load_catalog()
    return catalog.robot_for(name, sets) is None and catalog.bystander_for(name, sets) is not None
