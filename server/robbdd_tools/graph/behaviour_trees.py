"""Behaviour trees in the graph: which nodes they have, what makes them, which behaviours are linked to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.graph.executions import add_python

if TYPE_CHECKING:
    from rdflib.term import Node, URIRef

    from robbdd_tools.graph.sink import Frame
    from robbdd_tools.syntax import tree


def add_behaviour_tree(frame: Frame, declared: tree.BehaviourTree) -> None:
    """State a behaviour tree with its nodes in written order."""
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    frame.sink.add_types(node, ["rbw:BehaviourTree"], frame.at(declared.name))
    if declared.source is not None:
        add_python(frame, node, declared.source)
    nodes: list[Node] = []
    for part in declared.nodes:
        own = frame.claimed(f"{declared.name.text}.{part.name.text}", part.name)
        if own is not None:
            frame.sink.add_types(own, ["rbw:TreeNode"], frame.at(part.name))
            frame.sink.add(own, "rbw:node-of", node, frame.at(part.name))
            nodes.append(own)
    frame.sink.add(node, "rbw:node-list", frame.sink.make_list(nodes))


def link_behaviour(frame: Frame, behaviour: URIRef, use: tree.BehaviourUse) -> None:
    """State which node of a behaviour tree a behaviour is linked to, if any."""
    if use.node is not None:
        frame.sink.add(behaviour, "rbw:coordination-node", frame.target(use.node), frame.at(use.node))
