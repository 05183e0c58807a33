"""Group scenarios that are linked to nodes of the same behaviour tree, so that one execution can judge them all.

Scenarios are related if variables of the same name have the same value in all of them. A scenario may leave some of
these variables open (for example, pick an object, wherever it is placed). It joins the first group whose values agree
with its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.gherkin.feature import every_scenario
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    BehaviourTree,
    Cell,
    Execution,
    Iri,
    SceneModel,
    TreeNode,
    Variant,
)

Values = Mapping[Iri, Cell]
Key = tuple[Iri, Iri | None, int]
"""A variant, its execution if it has one, and the number of one of its scenarios."""


@dataclass(frozen=True, slots=True)
class Member:
    """A scenario that the behaviour in its ``When`` links to a node of a behaviour tree."""

    variant: Variant
    execution: Execution | None
    number: int
    values: Values
    link: BehaviourClause
    node: Iri

    @property
    def key(self) -> Key:
        """The key that identifies the scenario."""
        return self.variant.iri, None if self.execution is None else self.execution.iri, self.number


@dataclass(slots=True)
class Group:
    """Scenarios that are judged from one execution of a behaviour tree, in the order of the tree's nodes.

    ``number`` is the number of the group (from 1). ``values`` is the union of the values of its scenarios.
    """

    tree: BehaviourTree
    number: int
    members: list[Member] = field(default_factory=list[Member])
    values: dict[Iri, Cell] = field(default_factory=dict[Iri, Cell])

    def takes(self, member: Member) -> bool:
        """Return whether a scenario may join the group.

        Its values must agree with those of the members, and no member may be a scenario of the same variant.
        """
        if any(other.key[:2] == member.key[:2] for other in self.members):
            return False
        return all(self.values.get(name, value) == value for name, value in member.values.items())

    def add(self, member: Member) -> None:
        """Add a scenario and its values to the group."""
        self.members.append(member)
        self.values |= member.values


@dataclass(frozen=True, slots=True)
class Linked:
    """A behaviour-tree node that a variant is linked to. ``is_root`` is true if the node is the root of its tree."""

    node: Iri
    is_root: bool


class Relations:
    """The related scenarios of a model."""

    def __init__(self, model: AcceptanceModel) -> None:
        trees = {node: tree for tree in model.trees for node in tree.nodes}
        roots = {tree.root.iri for tree in model.trees if tree.root is not None}
        self._groups: dict[Key, Group] = {}
        links = list(_links(model, trees))
        self._linked = {variant.iri: Linked(node, node in roots) for variant, _, _, _, node in links}
        self.behaviours: dict[Iri, BehaviourClause] = {}
        """The behaviour of each linked node, taken from the first scenario linked to it."""
        for _, _, _, link, node in links:
            self.behaviours.setdefault(node, link)
        for tree in model.trees:
            order = {node: place for place, node in enumerate(tree.nodes)}
            own = [entry for entry in links if entry[-1] in order]
            for group in _groups(tree, sorted(own, key=lambda entry: order[entry[-1]])):
                self._groups.update((member.key, group) for member in group.members)

    def node(self, variant: Variant) -> Linked | None:
        """Return the behaviour-tree node that a variant is linked to, if any."""
        return self._linked.get(variant.iri)

    def group(self, variant: Iri, execution: Iri | None, number: int) -> Group | None:
        """Return the group of scenario ``number`` of a variant, or ``None`` if the variant has no behaviour tree."""
        return self._groups.get((variant, execution, number))


_Link = tuple[Variant, Execution | None, int, BehaviourClause, Iri]
"""A linked variant, its execution, the number of its setting, its behaviour and the node."""


def linked_behaviour(variant: Variant) -> BehaviourClause | None:
    """Return the behaviour that links a variant to a behaviour tree, if any."""
    found = (one for one in variant.template.clauses if isinstance(one, BehaviourClause))
    # A When with several behaviours states their order itself.
    return next((one for one in found if one.node and not one.has_siblings), None)


def _links(model: AcceptanceModel, trees: Mapping[Iri, BehaviourTree]) -> Iterator[_Link]:
    settings: list[_Setting] = []
    for variant in (variant for story in model.stories for variant in story.variants):
        link = linked_behaviour(variant)
        if link is None or link.node is None or link.node not in trees:
            continue
        executions = [execution for execution in model.executions if execution.variant == variant.iri]
        for execution in (None, *executions):
            setting = _setting(variant, execution)
            if setting not in settings:
                settings.append(setting)
            yield variant, execution, settings.index(setting), link, link.node


@dataclass(frozen=True, slots=True)
class _Setting:
    """Scenarios must have these data, apart from values, in common to be judged from one execution."""

    scene: SceneModel
    implementation: Implementation | None = None
    instance: SceneInstance | None = None
    seed: int | None = None
    timeout: float | None = None


def _setting(variant: Variant, execution: Execution | None) -> _Setting:
    if execution is None:
        return _Setting(variant.scene, instance=variant.instance)
    instance = execution.scene or variant.instance
    return _Setting(variant.scene, execution.implementation, instance, execution.seed, execution.timeout)


def _groups(tree: BehaviourTree, links: Iterable[_Link]) -> list[Group]:
    """Return the groups of a tree. The members of each group are in the order of ``links``."""
    found: list[Group] = []
    by_setting: dict[int, list[Group]] = {}
    for variant, execution, setting, link, node in links:
        known = by_setting.setdefault(setting, [])
        waiting = iter(list(known))
        for number, values in every_scenario(variant):
            member = Member(variant, execution, number, values, link, node)
            # Scenarios are mostly in the same order, so the next group usually fits; try the others last.
            group = next(waiting, None)
            if group is None or not group.takes(member):
                group = next((other for other in known if other.takes(member)), None)
            if group is None:
                group = Group(tree, len(found) + 1)
                found.append(group)
                known.append(group)
            group.add(member)
    return found


def roots_of(tree: BehaviourTree) -> tuple[TreeNode, ...]:
    """Return the top nodes of a tree: its root or, if code creates the tree, all its named nodes."""
    return tuple(TreeNode(node, "leaf") for node in tree.nodes) if tree.root is None else (tree.root,)
