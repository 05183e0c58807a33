"""Rules about the values that a variant gives to its template's variables."""

import pytest

from checks.models import LINES, SETS, check, fixed, found, marked, story
from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Severity

OTHER = (
    TEMPLATE.replace("fetch", "bring").replace("carry", "haul").replace("on-bench", "at-b").replace("in-tray", "at-t")
)
TABLE = """                | <fetch.part> | <fetch.robot> | <fetch.goal> |
                |---|
                | <parts.bolt> | <arms.panda> | <places.tray_ws> |
"""


def test_a_variable_without_a_value_is_reported_at_the_scenario() -> None:
    text = STORY.replace("                var <fetch.robot>: { <arms.panda> }\n", "").replace(
        "Scenario bench-to-tray {",
        "Scenario bench-to-tray {\n//               ^^^^^^^^^^^^^ missing-value no value to 'robot' of its template: "
        "add a line 'var <fetch.robot>: …'",
    )
    case = check(EVENTS + TEMPLATE + text)
    (finding,) = found(EVENTS + TEMPLATE + text)
    assert [place.message for place in finding.related] == ["'robot' is declared here"]
    assert case.uri == finding.related[0].uri


def test_all_variables_without_a_value_are_one_finding() -> None:
    (finding,) = found(story("                var <fetch.robot>: { <arms.panda> }\n"))
    assert finding.code == "missing-value"
    assert "'part' and 'goal'" in finding.message


def test_a_table_lacks_a_column() -> None:
    table = "                | <fetch.part> | <fetch.robot> |\n|---|\n| <parts.bolt> | <arms.panda> |\n"
    (finding,) = found(story(table))
    assert "add a column '<fetch.goal>' to the table" in finding.message


def test_a_misspelt_variable_is_not_missing_as_well() -> None:
    assert [entry.code for entry in found(MODEL.replace("var <fetch.part>:", "var <fetch.prat>:"))] == ["unknown-name"]


def test_a_broken_template_makes_no_value_missing() -> None:
    codes = {entry.code for entry in found(MODEL.replace("task: <task>", "task <task>", 1))}
    assert codes == {"syntax"}


def test_a_table_with_all_columns_is_sound() -> None:
    check(story(TABLE))


def test_a_second_line_for_one_variable_is_one_too_many() -> None:
    check(
        story(
            LINES + "                var <fetch.part>: { <parts.bolt> }\n"
            "//                   ^^^^^^^^^^ repeated-value 'fetch.part' already has values\n"
        )
    )


def test_a_second_column_for_one_variable_is_one_too_many() -> None:
    text = story(
        TABLE.replace("| <fetch.robot> |", "| <fetch.robot> | <fetch.part> |").replace(
            "| <arms.panda> |", "| <arms.panda> | <parts.bolt> |"
        )
    )
    (finding,) = found(text)
    assert finding.code == "repeated-value"
    assert "remove this column" in finding.message
    assert fixed(text, "repeated-value", "Remove this column") == story(TABLE)


def test_the_repeated_line_is_removed() -> None:
    line = "                var <fetch.part>: { <parts.bolt> }\n"
    assert fixed(story(LINES + line), "repeated-value") == story(LINES)


def test_a_variable_of_another_template_is_no_variable_here() -> None:
    text = EVENTS.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =") + TEMPLATE
    text += OTHER.replace("Template (ns=t)", "Template (ns=o)")
    lines = LINES.replace("<fetch.part>:", "<bring.part>:")
    text += STORY.replace(LINES, lines)
    findings = found(text, "foreign-variable")
    assert [text[entry.span.start : entry.span.end] for entry in findings] == ["bring.part"]
    assert "write 'fetch.part'" in findings[0].message
    assert "var <fetch.part>: obj set" in fixed(text, "foreign-variable")


def test_a_foreign_variable_is_not_changed_to_one_that_has_its_values() -> None:
    text = EVENTS.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =") + TEMPLATE
    text += OTHER.replace("Template (ns=t)", "Template (ns=o)")
    text += STORY.replace(LINES, LINES + LINES.splitlines(keepends=True)[0].replace("<fetch.part>", "<bring.part>"))
    (finding,) = found(text, "foreign-variable")
    assert finding.fixes == ()
    assert "name one of its variables" in finding.message


def test_a_clause_of_a_variant_speaks_of_its_own_template() -> None:
    text = EVENTS.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =") + TEMPLATE
    text += OTHER.replace("Template (ns=t)", "Template (ns=o)")
    clause = "Then: also: holds(<bring.part> is held by <fetch.robot>, after <end>)\n            variation:"
    text += STORY.replace("variation:", clause)
    findings = found(text, "foreign-variable")
    assert [text[entry.span.start : entry.span.end] for entry in findings] == ["bring.part"]


def test_templates_of_one_namespace_share_their_variables() -> None:
    text = EVENTS + TEMPLATE + OTHER + STORY.replace("<fetch.part>:", "<bring.part>:")
    assert found(text, "foreign-variable", "missing-value") == []


def test_a_variant_may_quantify_a_variable_of_its_own() -> None:
    clause = (
        "Then: ( var z exists in <parts> ) such that { also: holds(<z> is held by <fetch.robot>, after <end>) }\n"
        "            variation:"
    )
    check(EVENTS + TEMPLATE + STORY.replace("variation:", clause))


def test_a_short_row_is_completed_from_the_row_beside_it() -> None:
    text = story(
        TABLE + "                | <parts.nut> | <arms.ur10> |\n"
        "//              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ row-width 2 cells, but the table has 3 columns: "
        "add a value for 'fetch.goal'\n"
    )
    check(text)
    assert "| <parts.nut> | <arms.ur10> | <places.tray_ws> |" in fixed(text, "row-width")


def test_a_long_row_loses_what_is_too_much() -> None:
    text = story(TABLE + "                | <parts.nut> | <arms.ur10> | <places.tray_ws> | 3 | 4 |\n")
    assert "| <parts.nut> | <arms.ur10> | <places.tray_ws> |\n" in fixed(text, "row-width")


def test_a_row_may_break_over_lines() -> None:
    check(story(TABLE + "                | <parts.nut>\n | <arms.ur10>\n | <places.tray_ws>\n |\n"))


GOALS = "                set var <fetch.goals>: select 3 combinations from <places>\n"


def test_no_more_is_selected_than_there_is() -> None:
    text = story(
        LINES + GOALS + "//                                            ^ selection-size 'places' has only 2 elements\n",
        SETS,
    )
    check(text)
    assert "select 2 combinations" in fixed(text, "selection-size")


def test_repetition_allows_more_than_there_is() -> None:
    check(story(LINES + GOALS.replace("3 comb", "3 repeated comb"), SETS))
    check(story(LINES + GOALS.replace("select 3", "select 2"), SETS))
    assert len(found(story(LINES + GOALS.replace("combinations", "permutations"), SETS), "selection-size")) == 1


def test_a_selection_selects_something() -> None:
    for count in ("0", "-1", "1.5"):
        (finding,) = found(story(LINES + GOALS.replace("3", count), SETS))
        assert (finding.code, f"'select {count}'" in finding.message) == ("selection-size", True)


def test_a_line_without_values_makes_no_scenario() -> None:
    text = MODEL.replace("{ <arms.panda> }", "{ }")
    check(marked(text, "<fetch.robot>: «{ }»", "empty-set no value to choose from"))


def test_an_empty_inner_set_is_a_warning() -> None:
    text = story(LINES + "                set var <fetch.goals>: { { <places.tray_ws> }, { } }\n", SETS)
    (finding,) = found(text)
    assert (finding.code, finding.severity) == ("empty-set", Severity.WARNING)


def test_a_declared_set_without_elements_is_a_warning() -> None:
    check(
        "//- lab.scene\nns e = 'https://x/'\nobj set (ns=e) none { }\n//             ^^^^ empty-set 'none' is empty\n"
    )
    (finding,) = found("const set (ns=t) none { }\n" + MODEL, "empty-set")
    assert finding.severity is Severity.WARNING


def test_an_empty_set_makes_no_scenario_where_it_is_used() -> None:
    text = EVENTS + "const set (ns=t) none { }\n" + TEMPLATE + STORY.replace("{ <arms.panda> }", "set <none>")
    severities = [entry.severity for entry in found(text, "empty-set")]
    assert severities == [Severity.WARNING, Severity.ERROR]


SPARE = SCENE.replace("workspace tray_ws }", "workspace tray_ws, workspace shelf_ws }").replace(
    "obj set <parts> ws", "obj set <parts> obj set <washers> ws"
)


def test_a_value_outside_of_the_scene_is_pointed_out() -> None:
    text = "//- main.bdd\n" + MODEL.replace("<places.tray_ws> }", "<places.shelf_ws> }")
    (finding,) = found(text + "//- lab.scene\n" + SPARE, "not-in-scene")
    assert finding.severity is Severity.INFORMATION
    assert finding.message.startswith("'places.shelf_ws' is not in 'bench_scene'")
    assert finding.related[0].uri.endswith("lab.scene")


SHELF = "comp (ns=env) shelf_comp of ws <places.shelf_ws> { "


@pytest.mark.parametrize(
    ("composition", "count"),
    [
        ("", 1),
        (SHELF + "}\n", 1),
        (SHELF + "obj <furniture.bench> }\n", 0),
        (SHELF + "ws comp <tray_comp> }\n", 0),
    ],
)
def test_a_workspace_that_no_object_carries_is_a_warning(composition: str, count: int) -> None:
    scene = SPARE.replace("scene (ns", composition + "scene (ns")
    if composition:
        scene = scene.replace("ws comp <bench_comp>", "ws comp <bench_comp> ws comp <shelf_comp>")
    text = "//- main.bdd\n" + MODEL.replace("<places.tray_ws> }", "<places.shelf_ws>, <places.shelf_ws> }")
    findings = found(text + "//- lab.scene\n" + scene, "no-region")
    assert [finding.severity for finding in findings] == [Severity.WARNING] * count
    assert all(finding.message.startswith("no object of 'bench_scene' carries") for finding in findings)


def test_a_set_that_a_variation_names_comes_into_the_scene() -> None:
    check("//- main.bdd\n" + MODEL.replace("obj set <parts>", "obj set <furniture>") + "//- lab.scene\n" + SPARE)


def test_a_scene_without_agents_leaves_them_to_its_variants() -> None:
    check("//- main.bdd\n" + MODEL + "//- lab.scene\n" + SCENE.replace(" agn set <arms> }", " }"))


def test_an_unknown_scene_holds_nothing_against_a_value() -> None:
    assert found(MODEL.replace("scene: <bench_scene>", "scene: <bench_scen>"), "not-in-scene") == []


def test_a_variation_that_explodes_is_a_warning_with_its_size() -> None:
    template = TEMPLATE + "const set (ns=t) many { " + ", ".join(f"<washers.washer{n}>" for n in range(120)) + " }\n"
    scene = "//- lab.scene\n" + SCENE.replace("count: 3", "count: 120").replace(
        "workspace tray_ws }", "workspace tray_ws }\nsimilar ws set (ns=env) shelves { base name: shelf count: 84 }\n"
    )
    lines = LINES.replace("obj set <parts>", "set <many>").replace(
        "{ <places.bench_ws>, <places.tray_ws> }", "ws set <shelves>"
    )
    text = "//- main.bdd\n" + story(lines, template) + scene
    (finding,) = found(text, "many-scenarios")
    assert finding.severity is Severity.WARNING
    assert "10,080 scenarios (120 × 1 × 84)" in finding.message
    assert found(text.replace("count: 84", "count: 83"), "many-scenarios") == []


def test_a_huge_selection_is_not_counted_out() -> None:
    scene = "//- lab.scene\n" + SCENE.replace("count: 3", "count: 9000")
    for kind in ("permutations", "combinations", "repeated combinations", "repeated permutations"):
        lines = LINES + f"                set var <fetch.goals>: select 4000 {kind} from <washers>\n"
        text = "//- main.bdd\n" + story(lines, SETS.replace("<y>", "<goal>")) + scene
        (finding,) = found(text, "many-scenarios")
        assert "more than 1,000,000,000,000 scenarios" in finding.message


@pytest.mark.parametrize(
    ("selection", "factor"),
    [
        ("5 permutations", "95,040"),
        ("6 combinations", ""),
        ("6 repeated combinations", "12,376"),
        ("4 repeated permutations", "20,736"),
        ("10000 repeated permutations", "very many"),
        ("20000 repeated permutations", "very many"),
    ],
)
def test_selections_are_counted_by_their_kind(selection: str, factor: str) -> None:
    scene = "//- lab.scene\n" + SCENE.replace("count: 3", "count: 12")
    lines = LINES + f"                set var <fetch.goals>: select {selection} from <washers>\n"
    messages = [
        one.message
        for one in found("//- main.bdd\n" + story(lines, SETS.replace("<y>", "<goal>")) + scene, "many-scenarios")
    ]
    assert [f"({factor})" in message or f" × {factor})" in message for message in messages] == [True] * bool(factor)
