"""Read behaviour trees into plain data. Incomplete trees are left out."""

from __future__ import annotations

from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.graph.acceptance_model import BehaviourTree, Iri, TreeNode
from robbdd_tools.graph.rdf.records import Incomplete, Records, items_of
from robbdd_tools.graph.rdf.vocabulary import COMPOSITES
from robbdd_tools.graph.read.instances import Places, python_name


def read_trees(records: Records, places: Places) -> tuple[BehaviourTree, ...]:
    """Return the behaviour trees of a graph; ``places`` returns the source positions of nodes."""
    found: list[BehaviourTree] = []
    for node in records.instances("bt:BehaviourTree"):
        try:
            found.append(read_tree(records, node, places))
        except Incomplete:
            continue
    return tuple(found)


def read_tree(records: Records, node: Iri, places: Places) -> BehaviourTree:
    """Return one behaviour tree.

    Raises ``Incomplete`` if the tree has neither exactly one root nor code, or if it contains itself.
    """
    listed = records.iris(items_of(records, node, "rbw:node-list"))
    if records.is_a(node, "py:ModuleAttribute"):
        source = Implementation(node, "python", python_name(records, node), places(node))
        return BehaviourTree(node, listed, source=source)
    root = _node(records, records.one(node, "bt:root"), ())
    return BehaviourTree(node, listed or tuple(_iris(root)), root)


def _node(records: Records, node: Iri, above: tuple[Iri, ...]) -> TreeNode:
    if node in above:
        raise Incomplete(f"{node} contains itself")
    kind = next((kind for kind, class_ in COMPOSITES.items() if records.is_a(node, class_)), "leaf")
    if kind == "leaf":
        return TreeNode(node, kind)
    children = records.iris(records.list_of(node, "bt:children"))
    return TreeNode(node, kind, tuple(_node(records, child, (*above, node)) for child in children))


def _iris(node: TreeNode) -> list[Iri]:
    return [node.iri, *(iri for child in node.children for iri in _iris(child))]
