"""Leaves of behaviour trees have one behaviour each, once scenarios are linked to the tree."""

from __future__ import annotations

from checks.models import check, found
from kit import EVENTS, MODEL, STORY, TEMPLATE

LINK = "places at <goal>\n        }"
TREE = "Behaviour Tree (ns=t) handling {\n    sequence whole {\n        node pick\n        node place\n    }\n}\n"


def linked(node: str, template: str = TEMPLATE) -> str:
    assert LINK in template
    return template.replace(LINK, f"places at <goal>\n            node: <handling.{node}>\n        }}")


def other(text: str) -> str:
    """A second template with its own names, whose behaviour only picks."""
    for old, new in (("fetch", "take"), ("on-bench", "there"), ("in-tray", "taken"), ("carry", "get")):
        text = text.replace(old, new)
    return text.replace(" and places at <goal>", "")


def test_a_tree_that_no_scenario_is_linked_to_waits_for_them() -> None:
    check(MODEL + TREE)


def test_a_leaf_without_a_behaviour_is_told_once_the_tree_is_used() -> None:
    tree = TREE.replace(
        "node place\n", "node place\n//           ^^^^^ behaviour-tree no behaviour is linked to 'handling.place'\n"
    )
    check(EVENTS + tree + linked("pick") + STORY)
    check(
        EVENTS
        + tree.replace("node pick\n", "node pick\n//           ^^^^ behaviour-tree 'node: <handling.pick>'\n")
        + linked("whole")
        + STORY
    )


def test_a_library_is_linked_to_by_its_importers() -> None:
    library = "ns t = 'https://example.org/t/'\n" + TREE
    importer = EVENTS.replace("ns t", "import 'tree.bdd'\nns t") + linked("pick") + STORY
    (finding,) = found(f"//- tree.bdd\n{library}//- main.bdd\n{importer}", "behaviour-tree")
    assert "handling.place" in finding.message


def test_code_that_makes_the_tree_may_do_something_else_at_a_node() -> None:
    made = TREE.replace("sequence whole {", "py { module: m, attr: f }").replace("    }\n", "")
    check(EVENTS + made + linked("pick") + STORY)


def test_two_kinds_of_behaviour_need_two_nodes() -> None:
    tree = TREE.replace("        node place\n", "").replace(
        "node pick\n", "node pick\n//           ^^^^ behaviour-tree different behaviours, 'carry' and 'get'\n"
    )
    check(EVENTS + tree + linked("pick") + other(linked("pick")) + STORY)
    assert "different" in tree


def test_a_repeated_behaviour_is_no_single_nodes() -> None:
    loop = (
        linked("pick")
        .replace("    When:", "    for all ( var each in <parts> ) { When:", 1)
        .replace("    Then:", "    }\n    Then:", 1)
    )
    loop = loop.replace("var goal\n", "var goal\n    set var parts\n", 1).replace("picks <part>", "picks <each>")
    marked = "node: <handling.pick>\n//                 ^^^^^^^^^^^^^ behaviour-tree outside of 'for all'\n"
    tree = TREE.replace("        node place\n", "")
    check(
        EVENTS
        + tree
        + loop.replace("node: <handling.pick>\n", marked)
        + other(TEMPLATE)
        + STORY.replace("fetch", "take")
    )


def test_a_behaviour_with_siblings_belongs_to_no_node() -> None:
    lasting = "duration: from <pick-start> until <place-end>"
    second = f"\n        then Behaviour (ns=t) more {{ {lasting} <robot> picks <part> }}\n    Then:"
    finding = "behaviour-tree several behaviours states their order itself"
    marked = f"node: <handling.pick>\n//                 ^^^^^^^^^^^^^ {finding}\n"
    template = linked("pick").replace("    Then:", second, 1).replace("node: <handling.pick>\n", marked)
    check(EVENTS + TREE.replace("        node place\n", "") + template + STORY)
