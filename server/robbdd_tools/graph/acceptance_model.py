"""Acceptance criteria as plain data. They are read from a graph and used to generate Gherkin and to run scenarios.

The data depends neither on RDF nor on source text, so a model that was never written in RobBDD has the same form.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from robbdd_tools.base.selections import SelectionRule
from robbdd_tools.catalog.api import Predicate
from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.graph.requirement import Requirement
from robbdd_tools.graph.shown_properties import Column
from robbdd_tools.monitor.policy import Policy
from robbdd_tools.monitor.time import TimeConstraint
from robbdd_tools.protocol.recorded_log import RecordedLog


class Iri(str):
    """An IRI. Its type distinguishes it from a string of the user."""

    __slots__ = ()


Value = Iri | str | int | float
"""An element, a string or a number."""

Cell = Value | tuple[Value, ...]
"""The content of a variable in one scenario: a single value, or a set of values in written order."""


@dataclass(frozen=True, slots=True)
class Condition:
    """A predicate of ``whenever`` or of a defined event. Its fields have the same meaning as in a fluent."""

    iri: Iri
    predicate: str
    arguments: Mapping[str, Iri | str]
    named: Predicate | None = None


@dataclass(frozen=True, slots=True)
class Fluent:
    """A predicate under a time constraint. The events of the time constraint are IRIs.

    ``predicate`` is the name of the predicate in the catalog, or the IRI of the named predicate ``named``, in which
    elements have their IRIs. ``arguments`` maps each slot of the predicate to a
    variable, an element or a bare name. ``conditions`` select the samples at which the predicate must hold. ``seconds``
    is the variable whose value is the horizon of the time constraint (s), if any.
    """

    iri: Iri
    role: str
    predicate: str
    arguments: Mapping[str, Iri | str]
    time: TimeConstraint
    conditions: tuple[Condition, ...] = ()
    seconds: Iri | None = None
    named: Predicate | None = None


@dataclass(frozen=True, slots=True)
class TextFluent:
    """A fluent whose predicate is a text with placeholders such as ``{name}``.

    ``arguments`` maps each placeholder to a variable, an element or a literal.
    """

    iri: Iri
    role: str
    template: str
    arguments: Mapping[str, Iri | str]
    time: TimeConstraint
    conditions: tuple[Condition, ...] = ()
    seconds: Iri | None = None


@dataclass(frozen=True, slots=True)
class TextClause:
    """Free text under a time constraint."""

    iri: Iri
    role: str
    text: str
    time: TimeConstraint
    seconds: Iri | None = None


@dataclass(frozen=True, slots=True)
class Junction:
    """Clauses that are joined by ``and`` or ``or``, or negated by ``not``."""

    iri: Iri
    role: str
    operator: str
    operands: tuple[Clause, ...]


@dataclass(frozen=True, slots=True)
class EventClause:
    """``When: event <e> occurs``."""

    iri: Iri
    event: Iri


@dataclass(frozen=True, slots=True)
class BehaviourClause:
    """The behaviour in a ``When``.

    - ``behaviour``: the name of the behaviour in the catalog.
    - ``start`` and ``end``: the events of its duration.
    - ``node``: the node of a behaviour tree that executes it, if any.
    - ``emits``: maps the behaviour's own events (``pick-end``) to events of the model, in written order.
    - ``together``: the clause of the earlier behaviour that is executed at the same time (``meanwhile``), if any.
    - ``has_siblings``: true if the template has several behaviours.
    """

    iri: Iri
    behaviour: str
    arguments: Mapping[str, Iri | str]
    start: Iri
    end: Iri
    node: Iri | None = None
    emits: tuple[tuple[str, Iri], ...] = ()
    together: Iri | None = None
    has_siblings: bool = False


@dataclass(frozen=True, slots=True)
class ForAll:
    """A body that is repeated for each element of a set, which is a set variable or a constant set."""

    iri: Iri
    variable: Iri
    in_set: Iri
    clauses: tuple[Clause, ...]


@dataclass(frozen=True, slots=True)
class Exists:
    """Clauses that some element of a set must satisfy."""

    iri: Iri
    role: str
    variable: Iri
    in_set: Iri
    clauses: tuple[Clause, ...]


Clause = Fluent | TextFluent | TextClause | Junction | EventClause | BehaviourClause | ForAll | Exists


def every_clause(clauses: Iterable[Clause]) -> Iterator[Clause]:
    """Yield clauses at any depth, parents before their parts."""
    for clause in clauses:
        yield clause
        match clause:
            case ForAll(clauses=inner) | Exists(clauses=inner) | Junction(operands=inner):
                yield from every_clause(inner)
            case _:
                pass


def behaviour_clauses(clauses: Iterable[Clause]) -> Iterator[BehaviourClause]:
    """Yield the behaviours among clauses, at any depth."""
    return (clause for clause in every_clause(clauses) if isinstance(clause, BehaviourClause))


@dataclass(frozen=True, slots=True)
class Selection:
    """All sets of one size that can be selected from a set. ``kind`` is ``combinations`` or ``permutations``."""

    kind: str
    source: tuple[Value, ...]
    length: int
    repeated: bool

    @property
    def rule(self) -> SelectionRule:
        """The rule that counts and enumerates the selected sets."""
        return SelectionRule(self.kind, self.length, self.repeated)


@dataclass(frozen=True, slots=True)
class Product:
    """A Cartesian product. ``choices`` has one entry for each variable, and the last variable varies fastest."""

    variables: tuple[Iri, ...]
    choices: tuple[tuple[Cell, ...] | Selection, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """A table with one scenario for each row. Every row is as long as ``variables``."""

    variables: tuple[Iri, ...]
    rows: tuple[tuple[Cell, ...], ...]


@dataclass(frozen=True, slots=True)
class SceneModel:
    """The members of a variant's scene in written order.

    ``carriers`` maps a workspace to the objects that carry it. ``contains`` maps a workspace to the workspaces inside
    it. ``columns`` are the properties that the tables of its members show.
    """

    objects: tuple[Iri, ...]
    workspaces: tuple[Iri, ...]
    agents: tuple[Iri, ...]
    carriers: Mapping[Iri, tuple[Iri, ...]]
    contains: Mapping[Iri, tuple[Iri, ...]]
    columns: tuple[Column, ...] = ()


@dataclass(frozen=True, slots=True)
class DefinedEvent:
    """An event that occurs when all its conditions have become true, or have been true for ``seconds``.

    ``variable`` is the variable whose value is the number of seconds, if any.
    """

    iri: Iri
    conditions: tuple[Condition, ...]
    seconds: float = 0.0
    variable: Iri | None = None


@dataclass(frozen=True, slots=True)
class Template:
    """A scenario template with its clauses in order. The events ``start`` and ``end`` delimit every execution."""

    iri: Iri
    clauses: tuple[Clause, ...]
    start: Iri
    end: Iri
    events: tuple[DefinedEvent, ...] = ()


@dataclass(frozen=True, slots=True)
class Variant:
    """A scenario variant. Its scenarios have the clauses of its template, followed by its own clauses.

    ``scenes`` are the IRIs of its scene, if the graph names it. ``instance`` is the scene instance in which its
    scenarios run, unless their execution has its own.
    """

    iri: Iri
    template: Template
    clauses: tuple[Clause, ...]
    scene: SceneModel
    variation: Product | Table
    scenes: tuple[Iri, ...] = ()
    instance: SceneInstance | None = None


@dataclass(frozen=True, slots=True)
class Story:
    """A user story with its variants in written order."""

    iri: Iri
    role: str
    feature: str
    benefit: str
    variants: tuple[Variant, ...]


@dataclass(frozen=True, slots=True)
class TreeNode:
    """A node of a behaviour tree. ``kind`` is ``sequence``, ``selector`` or ``leaf``."""

    iri: Iri
    kind: str
    children: tuple[TreeNode, ...] = ()


@dataclass(frozen=True, slots=True)
class BehaviourTree:
    """A behaviour tree. It has nodes in written order, and either a root or Python code that creates the tree."""

    iri: Iri
    nodes: tuple[Iri, ...]
    root: TreeNode | None = None
    source: Implementation | None = None


@dataclass(frozen=True, slots=True)
class Execution:
    """An execution of a scenario variant.

    - ``implementation``: executes the behaviours of the variant in ``scene``.
    - ``policies``: judge clauses of the variant instead of the predicates of these clauses.
    - ``repeat``, ``seed``: the number of repetitions; determines all randomness (``None``: the seed of the run).
    - ``timeout``, ``log``: the limit in s of simulated time; the recording of a real robot that executed the variant.
    """

    iri: Iri
    variant: Iri
    implementation: Implementation
    scene: SceneInstance | None = None
    policies: tuple[Policy, ...] = ()
    repeat: int = 1
    seed: int | None = None
    timeout: float | None = None
    log: RecordedLog | None = None


@dataclass(frozen=True, slots=True)
class AcceptanceModel:
    """All acceptance criteria of a graph.

    - ``kinds``: maps each element to its kind (``object``, ``workspace`` or ``agent``).
    - ``sets``: the constant sets. ``prefixes``: maps each prefix to its namespace, for writing CURIEs.
    - ``executions``: the executions in written order.
    - ``correct_places``: maps an object to the workspaces that are stated to be correct for it.
    - ``verifies``: the requirements that a story, a variant, a template or a clause verifies.
    - ``implementations``: all implementations of behaviours, also those that no execution uses.
    - ``stated_settings``: maps an object to the configurations that its properties state, such as its mass (kg).
    - ``requirements``: all requirements in the order of their IRIs.
    """

    stories: tuple[Story, ...]
    kinds: Mapping[Iri, str]
    sets: Mapping[Iri, tuple[Value, ...]]
    prefixes: Mapping[str, str]
    executions: tuple[Execution, ...] = ()
    trees: tuple[BehaviourTree, ...] = ()
    correct_places: Mapping[Iri, tuple[Iri, ...]] = field(default_factory=dict[Iri, tuple[Iri, ...]])
    verifies: Mapping[Iri, tuple[Iri, ...]] = field(default_factory=dict[Iri, tuple[Iri, ...]])
    implementations: tuple[Implementation, ...] = ()
    stated_settings: Mapping[Iri, Mapping[str, str]] = field(default_factory=dict[Iri, Mapping[str, str]])
    requirements: tuple[Requirement, ...] = ()

    def curie(self, iri: str) -> str:
        """Return an IRI as a CURIE of the longest matching namespace. If none matches, return the IRI itself."""
        best = max(
            ((namespace, prefix) for prefix, namespace in self.prefixes.items() if iri.startswith(namespace)),
            key=lambda pair: len(pair[0]),
            default=None,
        )
        return iri if best is None else f"{best[1]}:{iri[len(best[0]) :]}"
