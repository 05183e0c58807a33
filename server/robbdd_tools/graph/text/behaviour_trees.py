"""Write behaviour trees of a graph as RobBDD text."""

from __future__ import annotations

from robbdd_tools.graph.acceptance_model import BehaviourTree, Iri, TreeNode
from robbdd_tools.graph.rdf.records import Incomplete
from robbdd_tools.graph.read.behaviour_trees import read_tree
from robbdd_tools.graph.text.names import Names, indented


def tree_text(names: Names, node: Iri) -> str:
    """Return a behaviour tree; raises ``Incomplete``."""
    tree = read_tree(names.records, node, lambda _: None)
    namespace = names.split(node)[0]
    name = names.declare(node, "tree")
    for part in tree.nodes:
        names.declare(part, "node", owner=name, namespace=namespace, before=f"node-{name}.")
    return f"Behaviour Tree (ns={names.prefix(namespace)}) {name} {{\n{indented(_contents(names, tree))}\n}}"


def _contents(names: Names, tree: BehaviourTree) -> str:
    if tree.root is not None:
        return _node(names, tree.root)
    if tree.source is None:
        raise Incomplete("it has neither a root nor code that makes it")
    module, _, attribute = tree.source.name.partition(":")
    nodes = [f"node {_name(names, node)}" for node in tree.nodes]
    return "\n".join([f"py {{ module: {module}, attr: {attribute} }}", *nodes])


def _node(names: Names, node: TreeNode) -> str:
    if node.kind == "leaf":
        return f"node {_name(names, node.iri)}"
    inner = "\n".join(_node(names, child) for child in node.children)
    return f"{node.kind} {_name(names, node.iri)} {{\n{indented(inner)}\n}}"


def _name(names: Names, node: Iri) -> str:
    return names.paths[node].rpartition(".")[2]
