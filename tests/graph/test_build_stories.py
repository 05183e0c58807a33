"""Stories, variants and variations become the published triples; order and narrative are kept by ours."""

from graph.statements import built, of, statements
from kit import EVENTS, MODEL, STORY, TEMPLATE

CHOICES = STORY[STORY.index("                var ") : STORY.index("        }\n}")]
SETS = TEMPLATE.replace("var goal", "var goal\n    set var goals")
INTEGER = "^^<http://www.w3.org/2001/XMLSchema#integer>"
DOUBLE = "^^<http://www.w3.org/2001/XMLSchema#double>"


def with_variation(variation: str, template: str = TEMPLATE) -> str:
    return EVENTS + template + STORY.replace(CHOICES, variation + "\n")


def test_a_story_keeps_its_narrative_and_the_order_of_its_variants() -> None:
    assert of(built(MODEL).graph, "t:fetching") == [
        "a bdd:UserStory",
        "bdd:has-criteria t:bench-to-tray",
        'rbw:benefit "work goes on"',
        "rbw:criteria-list (t:bench-to-tray)",
        'rbw:feature "parts fetched"',
        f'rbw:position "0"{INTEGER}',
        'rbw:role "operator"',
    ]


def test_a_variant_has_template_scene_variation_and_its_own_clauses() -> None:
    text = MODEL.replace(
        "            variation:",
        "            Given:\n                ready: holds(<fetch.robot> can reach <fetch.part>, before <start>)\n"
        "            When: event <pick-start> occurs\n            variation:",
    )
    graph = built(text).graph
    assert of(graph, "t:bench-to-tray") == [
        "a bdd:ScenarioVariant",
        "bdd:has-clause (t:ready t:when-evt-fetching.bench-to-tray.when.0)",
        "bdd:has-scene lab:bench_scene-scene-has-agn",
        "bdd:has-scene lab:bench_scene-scene-has-obj",
        "bdd:has-scene lab:bench_scene-scene-has-ws",
        "bdd:has-variation t:tv-cart_prod-fetching.bench-to-tray",
        "bdd:of-template t:fetch",
        "rbw:scene lab:bench_scene",
    ]
    assert "bdd:clause-of t:fetch-scenario-given" in of(graph, "t:ready")


def test_a_variant_without_clauses_has_an_empty_list() -> None:
    assert "bdd:has-clause ()" in of(built(MODEL).graph, "t:bench-to-tray")


def test_a_product_lists_variables_and_sets_side_by_side() -> None:
    assert of(built(MODEL).graph, "t:tv-cart_prod-fetching.bench-to-tray") == [
        "a bdd:CartesianProductVariation",
        "a bdd:TaskVariation",
        "bdd:of-sets (lab:parts (lab:panda) (lab:bench_ws lab:tray_ws))",
        "bdd:variable-list (t:var-part t:var-robot t:var-goal)",
        "task:of-task t:task",
    ]


def test_a_table_lists_its_rows_with_every_kind_of_cell() -> None:
    graph = built(
        with_variation(
            "| <fetch.part> | <fetch.robot> | <fetch.goals> |\n|---|\n"
            "| <parts.bolt> | 3 | { <places.bench_ws>, 0.5, 'x' } |\n"
            '| "a word" | -2e3 | ws set <places> |',
            SETS,
        )
    ).graph
    assert of(graph, "t:tv-table-fetching.bench-to-tray") == [
        "a bdd:TableVariation",
        "a bdd:TaskVariation",
        f'bdd:rows ((lab:bolt "3"{INTEGER} (lab:bench_ws "0.5"{DOUBLE} "x")) ("a word" "-2000.0"{DOUBLE} lab:places))',
        "bdd:variable-list (t:var-part t:var-robot t:var-goals)",
        "task:of-task t:task",
    ]


def test_selections_say_how_many_of_what_and_whether_repeated() -> None:
    lines = (
        "set var <fetch.goals>: select 2 repeated combinations from <places>\n"
        "set var <fetch.goals>: select 1 combinations from <places>\n"
        "set var <fetch.goals>: select 2 permutations from <places>\n"
        "set var <fetch.goals>: { { <places.bench_ws> }, { } }"
    )
    graph = built(with_variation(lines, SETS)).graph
    name = "fetching.bench-to-tray"
    assert f"bdd:of-sets (t:comb-{name}.0 t:comb-{name}.1 t:perm-{name}.2 ((lab:bench_ws) ()))" in of(
        graph, f"t:tv-cart_prod-{name}"
    )
    assert of(graph, f"t:comb-{name}.0") == [
        "a bdd:Combination",
        "bdd:from lab:places",
        'bdd:length "2"^^<http://www.w3.org/2001/XMLSchema#positiveInteger>',
        'bdd:repetition-allowed "true"^^<http://www.w3.org/2001/XMLSchema#boolean>',
    ]
    assert any(line.startswith('bdd:repetition-allowed "false"') for line in of(graph, f"t:comb-{name}.1"))
    assert not any("repetition" in line for line in of(graph, f"t:perm-{name}.2"))


def test_constant_sets_hold_numbers_and_strings_as_they_are() -> None:
    graph = built(EVENTS + "const set (ns=t) mixed { 1, 2.5, 'word', <parts.bolt>, 1 }").graph
    assert f'rbw:element-list ("1"{INTEGER} "2.5"{DOUBLE} "word" lab:bolt "1"{INTEGER})' in of(graph, "t:mixed")
    assert 'bdd:elements "word"' in of(graph, "t:mixed")


def test_stories_are_numbered_as_they_are_written() -> None:
    other = STORY.replace("fetching", "again").replace("bench-to-tray", "other")
    found = statements(built(MODEL + other).graph)
    assert {f't:fetching rbw:position "0"{INTEGER}', f't:again rbw:position "1"{INTEGER}'} <= found
