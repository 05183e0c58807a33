"""Write behaviour trees as triples: their nodes, the semantics of composites, and the linked behaviours.

Terms of the published metamodel of behaviour trees are used where they exist.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import COMPOSITES
from robbdd_tools.graph.write.executions import add_python
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from rdflib.term import Node, URIRef

    from robbdd_tools.graph.write.sink import Frame


def add_behaviour_tree(frame: Frame, declared: tree.BehaviourTree) -> None:
    """Add the triples of a behaviour tree, with its nodes in written order."""
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    sink = frame.sink
    sink.add_types(node, ["bt:BehaviourTree"], frame.at(declared.name))
    named = dict(_named(frame, declared, node))
    sink.add(node, "rbw:node-list", sink.make_list(named.values()))
    for part, own in named.items():
        if isinstance(part, tree.TreeComposite):
            sink.add_types(own, [COMPOSITES[part.kind]], frame.at(part.name))
            # Completed children are not ticked again while a later child runs.
            sink.add(own, "bt:memory", sink.literal(True), frame.at(part.name))
            sink.add(own, "bt:children", sink.make_list(_nodes(part.nodes, named)), frame.at(part.name))
            for child in part.nodes:
                if child in named:
                    sink.mark(own, "bt:children", named[child], frame.at(child.name))
        elif declared.source is None:
            sink.add_types(own, ["bt:Action"], frame.at(part.name))
    if declared.source is not None:
        add_python(frame, node, declared.source)
        return
    for part in declared.nodes:
        if part in named:
            sink.add(node, "bt:root", named[part], frame.at(part.name))


def _named(
    frame: Frame, declared: tree.BehaviourTree, node: URIRef
) -> Iterator[tuple[tree.TreeComposite | tree.TreeLeaf, URIRef]]:
    """Yield the named parts of a tree with their graph nodes."""
    for part in walk(declared):
        if isinstance(part, tree.TreeComposite | tree.TreeLeaf):
            own = frame.claimed(f"{declared.name.text}.{part.name.text}", part.name)
            if own is not None:
                frame.sink.add_types(own, ["rbw:TreeNode"], frame.at(part.name))
                frame.sink.add(own, "rbw:node-of", node, frame.at(part.name))
                yield part, own


def _nodes(parts: Iterable[tree.TreeNode], named: dict[tree.TreeComposite | tree.TreeLeaf, URIRef]) -> Iterator[Node]:
    return (named[part] for part in parts if part in named)


def link_behaviour(frame: Frame, behaviour: URIRef, use: tree.BehaviourUse) -> None:
    """Link a behaviour to the node of a behaviour tree, or of another coordination model, that it names, if any."""
    if use.node is not None:
        frame.sink.add(behaviour, "rbw:coordination-node", frame.target(use.node), frame.at(use.node))
    if use.external is not None:
        node = frame.sink.iri(use.external.value)
        frame.sink.add(behaviour, "rbw:external-node", node, frame.at(use.external))
