"""Each broken variation gets exactly the violation it should, on the token that causes it."""

import pytest

from graph.validated import CHOICES, SETS, check, findings, scene, story
from kit import EVENTS, STORY, TEMPLATE


def test_an_empty_set_is_a_warning() -> None:
    check(scene("obj set (ns=env) parts { }\n//               ^^^^^ shacl-set-elements add an element\n"))


def test_a_table_has_rows() -> None:
    text = story("| <fetch.part> | <fetch.robot> | <fetch.goal> |\n|---|\n")
    (found,) = findings(text)
    assert found.code == "shacl-table-rows"
    assert text[found.span.start : found.span.end].startswith("| <fetch.part>")


def test_a_row_is_as_wide_as_its_table() -> None:
    check(
        story(
            """
            | <fetch.part> | <fetch.robot> | <fetch.goal> |
            |---|
            | <parts.bolt> | <arms.panda> |
//          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ shacl-row-width 2 cells, but the table has 3 columns
            | <parts.bolt> | <arms.panda> | <places.tray_ws> |
"""
        )
    )


def test_every_variable_of_the_template_gets_a_value() -> None:
    text = story("var <fetch.part>: obj set <parts>\nvar <fetch.goal>: ws set <places>\n")
    (found,) = findings(text)
    assert found.code == "shacl-variable-missing"
    assert text[found.span.start : found.span.end] == "bench-to-tray"
    assert "'fetch.robot' gets no value" in found.message
    assert text[found.related[0].span.start : found.related[0].span.end] == "robot"


def test_a_variable_gets_its_values_once() -> None:
    check(
        story(
            """
            | <fetch.part> | <fetch.robot> | <fetch.goal> | <fetch.part> |
//             ^^^^^^^^^^ shacl-variable-repeated 2 times
//                                                           ^^^^^^^^^^ shacl-variable-repeated 2 times
            |---|
            | <parts.bolt> | <arms.panda> | <places.tray_ws> | <parts.nut> |
"""
        )
    )


def test_a_variable_of_another_template_is_refused() -> None:
    other = (
        TEMPLATE.replace("fetch", "bring")
        .replace("on-bench", "on-b")
        .replace("in-tray", "in-t")
        .replace("part", "thing")
    )
    text = EVENTS + other + TEMPLATE + STORY.replace("var <fetch.part>", "var <bring.thing>: { 1 }\n var <fetch.part>")
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-variable-foreign", "bring.thing")


def test_an_empty_choice_leaves_no_scenario() -> None:
    text = story("var <fetch.part>: { }\nvar <fetch.robot>: agn set <arms>\nvar <fetch.goal>: ws set <places>\n")
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-variable-empty", "fetch.part")


def test_values_fit_what_their_variable_stands_for_in_every_cell() -> None:
    check(
        story(
            """
            | <fetch.part> | <fetch.robot> | <fetch.goal> |
            |---|
            | <places.bench_ws> | <arms.panda> | <places.tray_ws> |
//             ^^^^^^^^^^^^^^^ shacl-object-value 'places.bench_ws' is not an object, but 'fetch.part'
            | <parts.bolt> | <parts.nut> | <places.tray_ws> |
//                            ^^^^^^^^^ shacl-agent-value 'parts.nut' is not an agent
            | <parts.bolt> | <arms.panda> | 3 |
//                                          ^ shacl-workspace-value '3' is not a workspace
            | <parts.bolt> | <parts.nut> | <places.tray_ws> |
//                            ^^^^^^^^^ shacl-agent-value 'parts.nut' is not an agent
"""
        )
    )


def test_a_set_of_the_wrong_kind_is_marked_where_it_is_named() -> None:
    check(
        story(
            """
                var <fetch.part>: ws set <places>
//                                        ^^^^^^ shacl-object-value 'places.bench_ws' is not an object
//                                        ^^^^^^ shacl-object-value 'places.tray_ws' is not an object
                var <fetch.robot>: { <arms.panda>, <arms.ur10> }
                var <fetch.goal>: { <places.tray_ws>, <parts.nut> }
//                                                     ^^^^^^^^^ shacl-workspace-value 'parts.nut' is not a workspace
"""
        )
    )


def test_what_stands_for_any_element_is_no_number() -> None:
    template = TEMPLATE.replace("var goal", "var goal\n    var other").replace(
        "<part> is located at <goal>, before", "<robot> does not collide <other>, before"
    )
    text = story(CHOICES + "var <fetch.other>: { <parts.nut>, 7 }\n", template)
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-element-value", "7")


def test_the_elements_a_quantifier_runs_over_count_too() -> None:
    text = story(CHOICES + "set var <fetch.goals>: { { <places.tray_ws>, <arms.ur10> } }\n", SETS)
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-workspace-value", "arms.ur10")


def test_a_quantifier_over_a_written_set_is_checked_as_well() -> None:
    template = SETS.replace("exists in <goals>", "exists in <arms>").replace("    set var goals\n", "")
    found = findings(EVENTS + template)
    assert {entry.code for entry in found} == {"shacl-workspace-value"}
    assert {(EVENTS + template)[entry.span.start : entry.span.end] for entry in found} == {"arms"}


def test_one_value_is_no_set_and_a_set_is_no_value() -> None:
    check(
        story(
            """
            | <fetch.part> | <fetch.robot> | <fetch.goal> | <fetch.goals> |
            |---|
            | obj set <parts> | <arms.panda> | { <places.tray_ws> } | <places.bench_ws> |
//                     ^^^^^ shacl-set-for-single takes one value in each scenario
//                                             ^^^^^^^^^^^^^^^^^^^^ shacl-set-for-single takes one value
//                                                                     ^^^^^^^^^^^^^^^ shacl-single-for-set needs a set
""",
            SETS,
        )
    )


def test_a_set_variable_in_a_product_needs_a_set_of_sets() -> None:
    text = story(CHOICES + "var <fetch.goals>: { <places.tray_ws> }\n", SETS)
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-single-for-set", "places.tray_ws")
    assert "'set var <fetch.goals>: { { … } }'" in found.message


@pytest.mark.parametrize(
    ("selection", "code", "token"),
    [
        ("select 3 combinations from <places>", "shacl-selection-size", "3"),
        ("select 3 permutations from <places>", "shacl-selection-size", "3"),
        ("select 0 combinations from <places>", "shacl-selection-length", "0"),
        ("select -1 permutations from <places>", "shacl-selection-length", "-1"),
        ("select 1.5 combinations from <places>", "shacl-selection-length", "1.5"),
        ("select 1 combinations from <fetch.goals>", "shacl-selection-source", "fetch.goals"),
    ],
)
def test_a_selection_takes_a_possible_number_of_written_elements(selection: str, code: str, token: str) -> None:
    text = story(CHOICES + f"set var <fetch.goals>: {selection}\n", SETS)
    (found,) = [entry for entry in findings(text) if entry.code == code]
    assert text[found.span.start : found.span.end] == token


def test_repeated_combinations_may_be_longer_than_the_set() -> None:
    assert (
        findings(story(CHOICES + "set var <fetch.goals>: select 5 repeated combinations from <places>\n", SETS)) == []
    )
