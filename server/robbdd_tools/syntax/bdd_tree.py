"""Syntax trees of acceptance criteria, one class per grammar rule. Spans count from the start of the chunk."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from robbdd_tools.syntax.predicate_tree import Argument, NamedUse, PhraseUse
from robbdd_tools.syntax.scene_tree import (
    Name,
    NamespaceArgument,
    Node,
    Number,
    PythonAttribute,
    Ref,
    Text,
    Where,
)
from robbdd_tools.syntax.time_tree import During, TimeConstraint
from robbdd_tools.syntax.variation_tree import Product, Table, Value


@dataclass(frozen=True, slots=True)
class Event(Node):
    """``Event (ns=…) name``."""

    namespace: NamespaceArgument | None
    name: Name


@dataclass(frozen=True, slots=True)
class Task(Node):
    """``Task (ns=…) name``."""

    namespace: NamespaceArgument | None
    name: Name


@dataclass(frozen=True, slots=True)
class Requirement(Node):
    """``Requirement (ns=…) name { "text" id: "…" source: "…" }``; ``identifier`` identifies it in other tools."""

    namespace: NamespaceArgument | None
    name: Name
    text: Text
    identifier: Text | None
    source: Text | None


@dataclass(frozen=True, slots=True)
class ConstantSet(Node):
    """``const set (ns=…) name { … }``."""

    namespace: NamespaceArgument | None
    name: Name
    values: tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class Variable(Node):
    """``var name`` or ``set var name``."""

    name: Name
    is_set: bool


@dataclass(frozen=True, slots=True)
class TextArgument(Node):
    """``name=<variable>`` or ``name="value"`` inside ``pred(…)``."""

    name: Name
    value: Argument


@dataclass(frozen=True, slots=True)
class TextPredicate(Node):
    """``pred("template", name=<variable>, other="value", …)``."""

    template: Text
    arguments: tuple[TextArgument, ...]


@dataclass(frozen=True, slots=True)
class Fluent(Node):
    """``name: holds(predicate [whenever conditions], time constraint) [verifies requirements]``.

    The module ``published`` generates the name if it is missing.
    """

    name: Name
    predicate: PhraseUse | TextPredicate | NamedUse
    conditions: tuple[PhraseUse | NamedUse, ...]
    time: TimeConstraint
    verifies: tuple[Ref, ...]


@dataclass(frozen=True, slots=True)
class TextClause(Node):
    """``"free text" time-constraint [verifies requirements]``."""

    text: Text
    time: TimeConstraint
    verifies: tuple[Ref, ...]


@dataclass(frozen=True, slots=True)
class Negation(Node):
    """``( not e )``."""

    operand: Expression


@dataclass(frozen=True, slots=True)
class Conjunction(Node):
    """``( e and e … )``, or a single expression in parentheses."""

    operands: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Disjunction(Node):
    """``( e or e … )``."""

    operands: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Exists(Node):
    """``( var y exists in <set> [where …] ) such that { e }``."""

    variable: Name
    in_set: Ref
    where: Where | None
    body: Expression


Expression = Fluent | TextClause | Negation | Conjunction | Disjunction | Exists


def bare(expression: Expression) -> Expression:
    """Remove parentheses around a single expression."""
    while isinstance(expression, Conjunction | Disjunction) and len(expression.operands) == 1:
        expression = expression.operands[0]
    return expression


@dataclass(frozen=True, slots=True)
class Occurrence(Node):
    """``event <e> occurs``."""

    event: Ref


@dataclass(frozen=True, slots=True)
class Emission(Node):
    """``emits <moment> as <event>``: maps the behaviour's own event (``moment``: ``pick-end``) to a model event."""

    moment: Name
    event: Ref


@dataclass(frozen=True, slots=True)
class NodeLink(Node):
    """``node: <…>`` or ``node: "IRI"``: a node of a behaviour tree, or of another coordination model."""

    node: Ref | None
    external: Text | None


@dataclass(frozen=True, slots=True)
class BehaviourUse(Node):
    """``Behaviour (ns=…) name { duration: … action emits … node: … }``.

    ``duration`` is ``None`` if the published form omits it and the clauses do not imply it.
    """

    namespace: NamespaceArgument | None
    name: Name
    duration: During | None
    action: PhraseUse
    emissions: tuple[Emission, ...]
    link: NodeLink | None

    @property
    def node(self) -> Ref | None:
        """The linked node of a behaviour tree."""
        return None if self.link is None else self.link.node

    @property
    def external(self) -> Text | None:
        """The IRI of the linked node of another coordination model."""
        return None if self.link is None else self.link.external


@dataclass(frozen=True, slots=True)
class Further(Node):
    """``then event <e> occurs Behaviour …`` or ``meanwhile Behaviour …``; ``link`` is the keyword."""

    link: str
    events: tuple[Occurrence, ...]
    behaviour: BehaviourUse


@dataclass(frozen=True, slots=True)
class When(Node):
    """``When:`` with its events and its behaviour, and further behaviours after it or at the same time."""

    events: tuple[Occurrence, ...]
    behaviour: BehaviourUse
    more: tuple[Further, ...]

    @property
    def steps(self) -> tuple[When | Further, ...]:
        """The parts of the ``When`` that have one behaviour each, in written order."""
        return (self, *self.more)

    @property
    def behaviours(self) -> tuple[BehaviourUse, ...]:
        """The behaviours in written order."""
        return tuple(step.behaviour for step in self.steps)


@dataclass(frozen=True, slots=True)
class ForAll(Node):
    """``for all ( var x in <set> [where …] ) { body }``."""

    variable: Name
    in_set: Ref
    where: Where | None
    body: Body


@dataclass(frozen=True, slots=True)
class Part(Node):
    """Given, then ``When`` or ``for all``, then Then."""

    given: Expression | None
    when: When | None
    for_all: ForAll | None
    then: Expression | None


@dataclass(frozen=True, slots=True)
class Body(Node):
    """Parts that are executed one after the other; at least one."""

    parts: tuple[Part, ...]

    @property
    def behaviours(self) -> Iterator[BehaviourUse]:
        """The behaviours at any depth in written order."""
        for part in self.parts:
            if part.when is not None:
                yield from part.when.behaviours
            if part.for_all is not None:
                yield from part.for_all.body.behaviours


@dataclass(frozen=True, slots=True)
class DefinedEvent(Node):
    """``event name when conditions [for h seconds]``: occurs when all conditions become true."""

    name: Name
    conditions: tuple[PhraseUse | NamedUse, ...]
    seconds: Number | Ref | None


@dataclass(frozen=True, slots=True)
class Template(Node):
    """``Scenario Template (ns=…) name { … }``."""

    namespace: NamespaceArgument | None
    name: Name
    duration: During | None
    task: Ref | None
    verifies: tuple[Ref, ...]
    variables: tuple[Variable, ...]
    events: tuple[DefinedEvent, ...]
    body: Body


@dataclass(frozen=True, slots=True)
class TreeLeaf(Node):
    """``node name`` inside a behaviour tree: executes the behaviour linked to it."""

    name: Name


@dataclass(frozen=True, slots=True)
class TreeComposite(Node):
    """``sequence name { … }`` or ``selector name { … }`` inside a behaviour tree; ``kind`` is the keyword."""

    kind: str
    name: Name
    nodes: tuple[TreeNode, ...]


TreeNode = TreeComposite | TreeLeaf


@dataclass(frozen=True, slots=True)
class BehaviourTree(Node):
    """``Behaviour Tree (ns=…) name { … }``: the nodes that behaviours can be linked to.

    The nodes are one root with all others below it. If ``source`` is given, Python code creates the named nodes.
    """

    namespace: NamespaceArgument | None
    name: Name
    source: PythonAttribute | None
    nodes: tuple[TreeNode, ...]


@dataclass(frozen=True, slots=True)
class Variant(Node):
    """``Scenario name { … }`` inside a user story."""

    name: Name
    template: Ref
    scene: Ref
    verifies: tuple[Ref, ...]
    given: Expression | None
    events: tuple[Occurrence, ...]
    then: Expression | None
    variation: Table | Product


@dataclass(frozen=True, slots=True)
class Story(Node):
    """``User Story (ns=…) name { … }``.

    Role, feature and benefit (``As A``, ``I Want``, ``So That``) are all given or all ``None``.
    """

    namespace: NamespaceArgument | None
    name: Name
    role: Text | None
    feature: Text | None
    benefit: Text | None
    verifies: tuple[Ref, ...]
    variants: Sequence[Variant]
