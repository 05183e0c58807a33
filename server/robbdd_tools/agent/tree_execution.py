"""Execute behaviour trees. Only this module uses py_trees."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, cast
from uuid import UUID

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence

from robbdd_tools.catalog.coordination import END, START, emitter
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.user_code.calls import UserCodeError, call_user_code, definition_of, load_attribute, refused
from robbdd_tools.world.errors import SceneError, SimulationError, UserError, at

if TYPE_CHECKING:
    from robbdd_tools.catalog.coordination import NodeSpec, TreeSpec

Attempt = Callable[["NodeSpec"], Generator[None, None, str]]
"""Executes the behaviour of a leaf, one control tick per step; returns why it failed, empty on success."""
COMPOSITES: dict[str, type[Selector | Sequence]] = {"sequence": Sequence, "selector": Selector}
NOT_REACHED = "precondition not reached"


class TreeRun:
    """A behaviour tree in execution. Raises ``SceneError`` if the tree cannot be created.

    - ``stamp``: called with ``<node> start`` when a node starts and with ``<node> end`` when it has succeeded, and with
      the number of the node's execution.
    - ``active``: the IRIs of the nodes whose behaviour is being executed, innermost first.
    - ``executions``: maps each emitter of events to the number of its executions so far (from 1).
    """

    def __init__(self, spec: TreeSpec, attempt: Attempt, stamp: Callable[[str, int], None]) -> None:
        self._attempt = attempt
        self._stamp = stamp
        self._spec = spec
        self._root = _made(spec, self._leaf) if spec.source is not None else self._declared(spec.nodes[0])
        self._nodes = {node.iri: _find(self._root, node.name, spec) for node in _every(spec.nodes)}
        self._iris = {behaviour.id: iri for iri, behaviour in self._nodes.items()}
        self._begun: set[object] = set()
        self._succeeded: set[object] = set()
        self._repeatable = {one.id for one in _preorder(self._root) if _may_repeat(one)}
        self.executions: Counter[str] = Counter()
        self._is_over = False
        self._failures: list[tuple[Behaviour, str]] = []
        self.active: tuple[str, ...] = ()

    def steps(self) -> Iterator[None]:
        """Tick the tree once in each control tick until the tree is over.

        Raises ``UserError`` if users' code fails, and ``SimulationError`` if the simulation becomes unstable.
        """
        while True:
            before = {behaviour.id: behaviour.status for behaviour in _preorder(self._root)}
            ticked = self._tick()
            self._take_note([one for one in _preorder(self._root) if one.id in ticked], before)
            if self._root.status is not Status.RUNNING:
                self._is_over = True
                return
            yield

    def has_begun(self, node: str) -> bool:
        """Return whether a node has been ticked."""
        return self._nodes[node].id in self._begun

    def is_over(self, node: str) -> bool:
        """Return whether a node has ended for good. A node that the tree may execute again ends with the tree."""
        return self._is_over or (self.has_succeeded(node) and self._nodes[node].id not in self._repeatable)

    def has_succeeded(self, node: str) -> bool:
        """Return whether the last execution of a node has succeeded."""
        return self._nodes[node].id in self._succeeded

    @property
    def pending(self) -> frozenset[str]:
        """The emitters of events that may be emitted again."""
        return frozenset() if self._is_over else self._repeated

    @cached_property
    def _repeated(self) -> frozenset[str]:
        """The emitters that belong to nodes that the tree may execute again."""
        found: set[str] = set()
        for iri, behaviour in self._nodes.items():
            if behaviour.id in self._repeatable:
                found |= {emitter(iri, START), emitter(iri, END)}
            for leaf in _preorder(behaviour):
                if isinstance(leaf, _Leaf) and leaf.id in self._repeatable:
                    found.update(emitter(iri, event) for event in leaf.events)
        return frozenset(found)

    def failure(self, node: str) -> str:
        """Return why a node failed: the reason of its last failed descendant, or an empty text if none failed."""
        return self._failure(self._nodes[node])[1]

    def unreached(self, node: str, remark: str) -> str:
        """Return the reason why a node of a finished tree was never ticked. ``remark`` is the latest problem."""
        found = self._nodes[node]
        while found.parent is not None and found.parent.id not in self._begun:
            found = found.parent
        siblings = [] if found.parent is None else found.parent.children
        before = [one for one in siblings[: siblings.index(found)] if one.id in self._begun] if siblings else []
        if before and before[-1].id in self._succeeded:
            return f"not reached: {before[-1].name} had already succeeded"
        name, reason = self._failure(before[-1]) if before else ("", "")
        if name:
            return f"{NOT_REACHED}: {name} failed: {reason}"
        return f"{NOT_REACHED}: {remark or 'the behaviour tree was over before'}"

    def _failure(self, node: Behaviour) -> tuple[str, str]:
        for leaf, reason in reversed(self._failures):
            if any(one is node for one in _upwards(leaf)):
                return leaf.name, reason
        return "", ""

    def _declared(self, node: NodeSpec) -> Behaviour:
        if node.kind == "leaf":
            return _Leaf(node, self._run)
        children = [self._declared(child) for child in node.children]
        return COMPOSITES[node.kind](name=node.name, memory=True, children=children)

    def _leaf(self, name: str) -> Behaviour:
        """Create the leaf that executes the behaviour of a node. Raises ``ValueError`` for an unknown node."""
        known = {node.name: node for node in self._spec.nodes}
        if name not in known:
            raise ValueError(f"the model declares no node '{name}' of this tree; it has {', '.join(known)}")
        return _Leaf(known[name], self._run)

    def _run(self, leaf: Behaviour, node: NodeSpec) -> Generator[None, None, str]:
        if node.problem:
            raise UserError(node.problem)
        steps = self._attempt(node)
        chain = tuple(self._iris[one.id] for one in _upwards(leaf) if one.id in self._iris)
        self.executions.update(emitter(iri, event) for iri in chain for event in _events_of(node))
        while True:
            self.active = chain
            try:
                next(steps)
            except StopIteration as end:
                if end.value:
                    self._failures.append((leaf, end.value))
                return end.value
            finally:
                self.active = ()
            yield

    def _tick(self) -> set[object]:
        """Tick the tree once; return the ids of the ticked behaviours."""

        def tick() -> set[object]:
            return {behaviour.id for behaviour in self._root.tick()}

        source = self._spec.source
        if source is None:
            return tick()
        try:
            return call_user_code(source.name, tick)
        except UserCodeError as error:
            if isinstance(error.__cause__, UserError | SimulationError):
                raise error.__cause__ from None
            raise UserError(f"{at(source.origin)}{error}", replace(error.fault, origin=source.iri)) from error

    def _take_note(self, ticked: Iterable[Behaviour], before: Mapping[UUID, Status]) -> None:
        """Record the events of the nodes that started or ended in this tick. ``before`` has their previous statuses."""
        for behaviour in ticked:
            iri = self._iris.get(behaviour.id)
            if before.get(behaviour.id) is not Status.RUNNING:
                self._begun.add(behaviour.id)
                self._succeeded.discard(behaviour.id)
                if iri is not None:
                    self.executions.update((emitter(iri, START), emitter(iri, END)))
                    self._stamp(emitter(iri, START), self.executions[emitter(iri, START)])
            if behaviour.status is Status.SUCCESS:
                self._succeeded.add(behaviour.id)
                if iri is not None:
                    self._stamp(emitter(iri, END), self.executions[emitter(iri, END)])


class _Leaf(Behaviour):
    """A leaf that executes one behaviour. Each tick of the tree is one control tick of the behaviour."""

    def __init__(self, node: NodeSpec, run: Callable[[Behaviour, NodeSpec], Generator[None, None, str]]) -> None:
        super().__init__(node.name)
        self._node = node
        self._run = run
        self._steps: Generator[None, None, str] | None = None

    @property
    def events(self) -> tuple[str, ...]:
        """The events of the leaf's behaviour."""
        return _events_of(self._node)

    def initialise(self) -> None:
        """Start the behaviour again."""
        self._steps = self._run(self, self._node)

    def update(self) -> Status:
        """Execute the next control tick."""
        assert self._steps is not None
        try:
            next(self._steps)
        except StopIteration as end:
            return Status.FAILURE if end.value else Status.SUCCESS
        return Status.RUNNING


def _events_of(node: NodeSpec) -> tuple[str, ...]:
    return load_catalog().behaviours[node.behaviour].events if node.behaviour else ()


def _may_repeat(behaviour: Behaviour) -> bool:
    """Return whether the tree may execute a behaviour again.

    This is not so if all composites above the behaviour are sequences and selectors with memory.
    """
    above = islice(_upwards(behaviour), 1, None)
    return not all(type(one) in COMPOSITES.values() and cast("Sequence | Selector", one).memory for one in above)


def _made(spec: TreeSpec, leaf: Callable[[str], Behaviour]) -> Behaviour:
    """Return the tree that the user's function creates from leaves. Raises ``SceneError``."""
    source = spec.source
    assert source is not None
    place, model = at(source.origin), "" if source.origin is None else source.origin.file
    try:
        make = load_attribute(source.name, model)
        root: object = call_user_code(source.name, make, leaf)
        if not isinstance(root, Behaviour):
            message = f"'{source.name}' returned a {type(root).__name__}, not a behaviour of py_trees"
            raise refused(source.name, message, definition_of(make))
    except UserCodeError as error:
        raise SceneError(f"{place}{error}", replace(error.fault, origin=source.iri)) from error
    return root


def _find(root: Behaviour, name: str, spec: TreeSpec) -> Behaviour:
    found = [behaviour for behaviour in _preorder(root) if behaviour.name == name]
    if len(found) != 1:
        place = at(None if spec.source is None else spec.source.origin)
        raise SceneError(f"{place}the behaviour tree has {len(found)} nodes called '{name}', not one")
    return found[0]


def _preorder(node: Behaviour) -> Iterator[Behaviour]:
    yield node
    for child in node.children:
        yield from _preorder(child)


def _upwards(node: Behaviour) -> Iterator[Behaviour]:
    above: Behaviour | None = node
    while above is not None:
        yield above
        above = above.parent


def _every(nodes: tuple[NodeSpec, ...]) -> Iterator[NodeSpec]:
    for node in nodes:
        yield node
        yield from _every(node.children)
