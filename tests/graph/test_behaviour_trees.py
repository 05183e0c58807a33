"""Behaviour trees and the behaviours that are linked to their nodes."""

from __future__ import annotations

from rdflib import RDF, BNode, URIRef

from graph.statements import built, of
from graph.test_text import assert_identity
from graph.validated import check
from kit import EVENTS, STORY, TEMPLATE
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.shapes.validate import validate

TREE = "Behaviour Tree (ns=t) handling { py { module: my_pkg.trees, attr: create } node pick node place }\n"
LINKED = TEMPLATE.replace(
    "places at <goal>\n        }", "places at <goal>\n            node: <handling.pick>\n        }"
)


def test_a_tree_has_its_nodes_in_written_order_and_what_makes_it() -> None:
    graph = built(EVENTS + TREE + TEMPLATE).graph
    assert of(graph, "t:handling") == [
        "a bt:BehaviourTree",
        "a py:ModuleAttribute",
        'py:attribute-name "create"',
        'py:module-name "my_pkg.trees"',
        "rbw:node-list (t:node-handling.pick t:node-handling.place)",
    ]
    assert of(graph, "t:node-handling.pick") == ["a rbw:TreeNode", "rbw:node-of t:handling"]


NESTED = """Behaviour Tree (ns=t) handling {
    sequence whole {
        selector grasp {
            node pick
            node pick-again
        }
        node place
    }
}
"""


def test_composites_have_their_children_in_order_below_one_root() -> None:
    graph = built(EVENTS + NESTED + TEMPLATE).graph
    assert of(graph, "t:handling") == [
        "a bt:BehaviourTree",
        "bt:root t:node-handling.whole",
        "rbw:node-list (t:node-handling.whole t:node-handling.grasp t:node-handling.pick"
        " t:node-handling.pick-again t:node-handling.place)",
    ]
    assert of(graph, "t:node-handling.whole") == [
        "a bt:Sequence",
        "a rbw:TreeNode",
        "bt:children (t:node-handling.grasp t:node-handling.place)",
        f'bt:memory "true"^^<{expand("xsd:boolean")}>',
        "rbw:node-of t:handling",
    ]
    assert "a bt:Selector" in of(graph, "t:node-handling.grasp")
    assert of(graph, "t:node-handling.place") == ["a bt:Action", "a rbw:TreeNode", "rbw:node-of t:handling"]


def test_a_tree_is_read_back_as_plain_data() -> None:
    (tree,) = read_model(built(EVENTS + NESTED + TEMPLATE).graph).trees
    assert tree.root is not None
    assert [(child.kind, len(child.children)) for child in tree.root.children] == [("selector", 2), ("leaf", 0)]
    (made,) = read_model(built(EVENTS + TREE + TEMPLATE).graph).trees
    assert (made.root, made.source and made.source.name, len(made.nodes)) == (None, "my_pkg.trees:create", 2)


def test_a_cyclic_tree_is_no_tree() -> None:
    graph = built(EVENTS + NESTED + TEMPLATE).graph
    grasp, whole = (URIRef(f"https://example.org/t/node-handling.{name}") for name in ("grasp", "whole"))
    children = URIRef(expand("bt:children"))
    graph.remove((grasp, children, None))
    head = BNode()
    graph.add((grasp, children, head))
    graph.add((head, RDF.first, whole))
    graph.add((head, RDF.rest, RDF.nil))
    assert read_model(graph).trees == ()


def test_a_tree_is_written_back_as_text() -> None:
    for declared in (NESTED, TREE):
        assert_identity(built(EVENTS + declared + LINKED + STORY).graph)


def test_a_tree_has_one_root() -> None:
    check(
        EVENTS
        + """Behaviour Tree (ns=t) two {
    node pick
//       ^^^^ shacl-tree-root put its nodes into a 'sequence <name> { … }'
    node place
}
"""
    )
    check(EVENTS + "Behaviour Tree (ns=t) none { }\n//                    ^^^^ shacl-tree-made has a root\n")


def test_a_behaviour_is_linked_to_a_node() -> None:
    assert LINKED != TEMPLATE
    found = built(EVENTS + TREE + LINKED)
    assert "rbw:coordination-node t:node-handling.pick" in of(found.graph, "t:carry")
    assert not [finding for finding in validate(found) if "node" in finding.message]


def test_a_node_may_have_the_name_of_its_behaviour() -> None:
    named = LINKED.replace("Behaviour (ns=t) carry", "Behaviour (ns=t) pick")
    assert named != LINKED
    assert "rbw:coordination-node t:node-handling.pick" in of(built(EVENTS + TREE + named).graph, "t:pick")
