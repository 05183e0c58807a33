"""Find the names that a tree declares and uses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, cast

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, Reference, Symbol, SymbolKind
from robbdd_tools.syntax.move import InPlace
from robbdd_tools.syntax.recover import HOLE
from robbdd_tools.syntax.scene_tree import field_names

MAX_COPIES = 10_000
"""Maximum number of named members of a ``similar`` set. A larger count is assumed to be a typing error."""

_SETS = {
    "object": SymbolKind.OBJECT_SET,
    "workspace": SymbolKind.WORKSPACE_SET,
    "agent": SymbolKind.AGENT_SET,
}
_TOP: dict[type[tree.Node], SymbolKind] = {
    tree.Event: SymbolKind.EVENT,
    tree.Task: SymbolKind.TASK,
    tree.Requirement: SymbolKind.REQUIREMENT,
    tree.ConstantSet: SymbolKind.CONSTANT_SET,
    tree.NamedPredicate: SymbolKind.PREDICATE,
    tree.Composition: SymbolKind.COMPOSITION,
    tree.Scene: SymbolKind.SCENE,
    tree.Template: SymbolKind.TEMPLATE,
    tree.Story: SymbolKind.STORY,
    tree.BehaviourTree: SymbolKind.BEHAVIOUR_TREE,
    tree.Distribution: SymbolKind.DISTRIBUTION,
    tree.KinematicTree: SymbolKind.TREE,
    tree.TreeInstance: SymbolKind.TREE_INSTANCE,
    tree.SceneInstance: SymbolKind.SCENE_INSTANCE,
    tree.Implementation: SymbolKind.IMPLEMENTATION,
    tree.Provider: SymbolKind.PROVIDER,
    tree.Observation: SymbolKind.OBSERVATION,
    tree.Policy: SymbolKind.POLICY,
    tree.RobotLog: SymbolKind.ROBOT_LOG,
    tree.Execution: SymbolKind.EXECUTION,
}


def symbols(root: tree.DeclarationTree) -> tuple[Symbol, ...]:
    """Return the names that a declaration declares: first its own name, then the names of its parts in text order."""
    if isinstance(root, tree.Import):
        return ()
    if isinstance(root, tree.Namespace):
        return (Symbol(root.name.text, root.name.text, SymbolKind.NAMESPACE, root.name.span, root.span, None),)
    if isinstance(root, tree.KinematicTree) and root.namespace is None:
        own = Symbol(root.name.text, root.name.text, SymbolKind.TREE_TEMPLATE, root.name.span, root.span, None)
        return (own, *_tree_parts(root, root.name.text))
    namespace = FILE_NAMESPACE if root.namespace is None else root.namespace.reference.path
    kind = _SETS[root.kind] if isinstance(root, tree.ElementSet | tree.SimilarSet) else _TOP[type(root)]
    target = root.template.path if isinstance(root, tree.TreeInstance) else None
    own = Symbol(root.name.text, root.name.text, kind, root.name.span, root.span, namespace, target)
    return (own, *_parts(root, root.name.text, namespace))


def _parts(root: tree.DeclarationTree, path: str, namespace: str) -> Iterator[Symbol]:
    match root:
        case tree.ElementSet():
            for member in root.members:
                yield _symbol(path, member.name, SymbolKind(root.kind), member.span, namespace)
        case tree.SimilarSet():
            count = root.count.value if isinstance(root.count.value, int) else 0
            for index in range(min(count, MAX_COPIES)):
                name = f"{root.base.text}{index}"
                kind = SymbolKind(root.kind)
                yield Symbol(f"{path}.{name}", name, kind, root.base.span, root.span, namespace)
        case tree.NamedPredicate():
            for parameter in root.parameters:
                yield _symbol(path, parameter.name, SymbolKind.PARAMETER, parameter.span, namespace)
        case tree.Template():
            for variable in root.variables:
                kind = SymbolKind.SET_VARIABLE if variable.is_set else SymbolKind.VARIABLE
                yield _symbol(path, variable.name, kind, variable.span, namespace)
            for event in root.events:
                yield _symbol(path, event.name, SymbolKind.EVENT, event.span, namespace)
            yield from _clauses(root.body, path, namespace)
        case tree.Story():
            for variant in root.variants:
                yield from variant_symbols(variant, path, namespace)
        case tree.BehaviourTree():
            for node in walk(root):
                if isinstance(node, tree.TreeComposite | tree.TreeLeaf):
                    yield _symbol(path, node.name, SymbolKind.TREE_NODE, node.span, namespace)
        case tree.KinematicTree():
            yield from _tree_parts(root, path)
        case tree.SceneInstance():
            yield from _instance_parts(root, path)
        case _:
            pass


def variant_symbols(variant: tree.Variant, path: str, namespace: str | None) -> tuple[Symbol, ...]:
    """Return the names that a scenario of the story at ``path`` declares, itself first."""
    own = _symbol(path, variant.name, SymbolKind.VARIANT, variant.span, namespace)
    return (own, *_clauses(variant, own.path, namespace))


def _instance_parts(owner: tree.SceneInstance | tree.Modelled, path: str) -> Iterator[Symbol]:
    """Yield graphs, models and sensors of a scene instance; modelled elements are declared elsewhere."""
    for entry in owner.entries:
        match entry:
            case tree.Graph():
                own = entry.namespace.reference.path
                yield _symbol(path, entry.name, SymbolKind.GRAPH, entry.span, own)
                yield from _tree_parts(entry, f"{path}.{entry.name.text}")
            case tree.Model():
                yield _symbol(path, entry.name, SymbolKind.MODEL, entry.span, None)
            case tree.Camera() | tree.Sensor():
                yield _symbol(path, entry.name, SymbolKind.SENSOR, entry.span, None)
            case tree.Modelled():
                yield from _instance_parts(entry, path)
            case tree.PairFriction() | tree.WorkspaceBox():
                pass


def _tree_parts(owner: tree.KinematicTree | tree.Graph, path: str) -> Iterator[Symbol]:
    """Yield bodies with their frames and poses, and joints."""
    for entry in owner.entries:
        match entry:
            case tree.RigidBody():
                yield _symbol(path, entry.name, SymbolKind.BODY, entry.span, None)
                yield from _body_parts(entry, f"{path}.{entry.name.text}")
            case tree.Joints():
                for joint in entry.entries:
                    if isinstance(joint, tree.FixedJoint | tree.RevoluteJoint):
                        yield _symbol(path, joint.name, SymbolKind.JOINT, joint.span, None)
            case tree.TreeUse():
                pass


def _body_parts(body: tree.RigidBody, path: str) -> Iterator[Symbol]:
    for frame in body.parts:
        if isinstance(frame, tree.Frame):
            yield _symbol(path, frame.name, SymbolKind.FRAME, frame.span, None)
            for pose in frame.poses:
                yield _symbol(f"{path}.{frame.name.text}", pose.name, SymbolKind.POSE, pose.span, None)


def _clauses(node: tree.Node, path: str, namespace: str | None) -> Iterator[Symbol]:
    """Yield fluents, behaviours and quantified variables of a template or variant."""
    for part in walk(node):
        match part:
            case tree.Fluent():
                yield _symbol(path, part.name, SymbolKind.FLUENT, part.span, namespace)
            case tree.BehaviourUse():
                own = namespace if part.namespace is None else part.namespace.reference.path
                yield _symbol(path, part.name, SymbolKind.BEHAVIOUR, part.span, own)
            case tree.ForAll() | tree.Exists():
                yield _symbol(path, part.variable, SymbolKind.VARIABLE, part.variable.span, namespace)
            case _:
                pass


def _symbol(path: str, name: tree.Name, kind: SymbolKind, extent: Span, namespace: str | None) -> Symbol:
    return Symbol(f"{path}.{name.text}", name.text, kind, name.span, extent, namespace)


def references(root: tree.Node, scopes: tuple[str, ...] = ()) -> tuple[Reference, ...]:
    """Return every use of a name in a declaration, or in a part of one inside ``scopes``, in text order."""
    found: list[Reference] = []
    _collect(root, scopes, found)
    # An event from which a duration was derived occurs twice in the tree, but once in the text.
    every = (reference for reference in dict.fromkeys(found) if reference.ref.path != HOLE)
    return tuple(sorted(every, key=lambda reference: reference.ref.span))


def _collect(node: tree.Node, scopes: tuple[str, ...], found: list[Reference]) -> None:
    if isinstance(node, tree.Ref):
        found.append(Reference(node, scopes))
        return
    if isinstance(node, tree.Template | tree.Story | tree.NamedPredicate | tree.KinematicTree | tree.SceneInstance):
        scopes = (node.name.text,)
    elif isinstance(node, tree.Variant | tree.Graph | tree.RigidBody):
        scopes = (f"{scopes[0]}.{node.name.text}", *scopes)
    for child in children(node):
        _collect(child, scopes, found)


def children(node: tree.Node) -> Iterator[tree.Node]:
    """Yield the nodes directly below a node, in the order of the grammar."""
    for name in field_names(type(node)):
        yield from _nodes(getattr(node, name))


def walk(node: tree.Node) -> Iterator[tree.Node]:
    """Yield a node and all its descendants, in the order of the grammar."""
    yield node
    for child in children(node):
        yield from walk(child)


def walk_at(node: tree.Node, offset: int) -> Iterator[tree.Node]:
    """Yield a node and its descendants that contain or touch an offset, in the order of the grammar."""
    if node.span.contains(offset):
        yield node
        for child in children(node):
            yield from walk_at(child, offset)


def _nodes(value: Any) -> Iterator[tree.Node]:
    if isinstance(value, tree.Node):
        yield value
    elif isinstance(value, tuple | InPlace):
        for entry in cast(Sequence[Any], value):
            yield from _nodes(entry)
