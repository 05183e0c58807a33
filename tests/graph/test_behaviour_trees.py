"""Behaviour trees and the behaviours that are linked to their nodes."""

from __future__ import annotations

from graph.statements import built, of
from kit import EVENTS, TEMPLATE
from robbdd_tools.graph.validate import validate

TREE = "Behaviour Tree (ns=t) handling { py { module: my_pkg.trees, attr: create } node pick node place }\n"
LINKED = TEMPLATE.replace(
    "places at <goal>\n        }", "places at <goal>\n            node: <handling.pick>\n        }"
)


def test_a_tree_has_its_nodes_in_written_order_and_what_makes_it() -> None:
    graph = built(EVENTS + TREE + TEMPLATE).graph
    assert of(graph, "t:handling") == [
        "a py:ModuleAttribute",
        "a rbw:BehaviourTree",
        'py:attribute-name "create"',
        'py:module-name "my_pkg.trees"',
        "rbw:node-list (t:node-handling.pick t:node-handling.place)",
    ]
    assert of(graph, "t:node-handling.pick") == ["a rbw:TreeNode", "rbw:node-of t:handling"]


def test_a_behaviour_is_linked_to_a_node() -> None:
    assert LINKED != TEMPLATE
    found = built(EVENTS + TREE + LINKED)
    assert "rbw:coordination-node t:node-handling.pick" in of(found.graph, "t:carry")
    assert not [finding for finding in validate(found) if "node" in finding.message]


def test_a_node_may_have_the_name_of_its_behaviour() -> None:
    named = LINKED.replace("Behaviour (ns=t) carry", "Behaviour (ns=t) pick")
    assert named != LINKED
    assert "rbw:coordination-node t:node-handling.pick" in of(built(EVENTS + TREE + named).graph, "t:pick")
