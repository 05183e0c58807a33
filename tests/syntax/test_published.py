"""The published form is read into the same trees as the current one."""

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Any, cast

import pytest

from kit import EVENTS, MODEL, SCENE, TEMPLATE, assert_diagnostics, fixture
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.split import split

CURRENT = """ns t = 'https://example.org/t/'
Event (ns=t) pickup_start
Event (ns=t) place_end
Scenario Template (ns=t) fetch {
    duration: from <pickup_start> until <place_end>
    var part
    var robot
    var start
    var goal
    Given: (
        fetch-given-1: holds(<part> is located at <start>, before <pickup_start>)
        and fetch-given-2: holds(<robot> can reach <part>, before <pickup_start>)
    )
    When:
        Behaviour (ns=t) fetch-pick-place {
            duration: from <pickup_start> until <place_end>
            <robot> picks <part> and places at <goal>
        }
    Then: (
        fetch-then-1: holds(<part> is located at <goal>, 0.5 seconds after <place_end>)
        and fetch-then-2: holds(<robot> does not collide <goal>, from <pickup_start> until <place_end>)
    )
}
User Story (ns=t) fetching {
    As A "operator" I Want "parts fetched" So That "work goes on"
    Scenarios:
        Scenario bench-to-tray {
            template: <fetch>
            scene: <bench_scene>
            Then: bench-to-tray-then-1: holds(<fetch.part> is held by <fetch.robot>, after <place_end>)
            variation:
                var <fetch.part>: { <parts.bolt>, <parts.nut> }
                var <fetch.robot>: { <arms.panda> }
                var <fetch.start>: { <places.bench_ws> }
                var <fetch.goal>: { <places.tray_ws>, 3 }
        }
}
"""
PUBLISHED = """ns t = 'https://example.org/t/'
Event pickup_start
Event place_end
Scenario Template fetch {
    var part
    var robot
    var start
    var goal
    Given:
        <part> is located at <start> before <pickup_start>
        holds(<robot> can reach <part>, before <pickup_start>)
    When: <robot> picks <part> and places it at <goal>
    Then:
        <part> is located at <goal> 0.5 seconds after <place_end>
        <robot> does not collide <goal> from <pickup_start> until <place_end>
}
User Story fetching {
    As A "operator" I Want "parts fetched" So That "work goes on"
    Scenario Variant bench-to-tray {
        template: <fetch>
        scene: <bench_scene>
        Then: <fetch.part> is held by <fetch.robot> after <place_end>
        <part> can be:
            - obj <parts.bolt>
            - obj <parts.nut>
        var <fetch.robot> can be:
            - agn <arms.panda>
        <start> can be: - ws <places.bench_ws>
        <goal> can be: - ws <places.tray_ws> - 3
    }
}
"""
SCENE_IMPORT = 'import "lab.scene"\n'


def shape(node: Any) -> Any:
    """A tree without its spans; differences of the form itself are normalised.

    The published form omits a namespace that is unambiguous, and states the kind of each listed value.
    """
    if isinstance(node, Sequence) and not isinstance(node, str):
        return tuple(shape(entry) for entry in cast(Sequence[Any], node))
    if isinstance(node, tree.Ref):
        return ("Element" if node.role in ("Object", "Workspace", "Agent") else node.role, node.path)
    if not is_dataclass(node) or isinstance(node, type):
        return node
    parts = (field.name for field in fields(node) if field.name not in ("span", "namespace"))
    return (type(node).__name__, *((name, shape(getattr(node, name))) for name in parts))


def trees(text: str) -> list[Any]:
    declarations = [parse_declaration("bdd", chunk.text) for chunk in split("bdd", text)]
    assert [fault for declaration in declarations for fault in declaration.faults] == []
    return [declaration.tree for declaration in declarations]


def graph(text: str) -> str:
    case = fixture(SCENE_IMPORT + text)
    return serialize(build_graph(case.snapshot, case.uri).graph, "ttl")


def test_both_forms_have_equal_trees() -> None:
    for current, published in zip(trees(CURRENT), trees(PUBLISHED), strict=True):
        assert shape(current) == shape(published)


def test_both_forms_have_equal_graphs() -> None:
    assert graph(PUBLISHED) == graph(CURRENT)
    assert "fetch-given-2" in graph(CURRENT)


def test_the_published_form_has_no_finding() -> None:
    case = fixture(SCENE_IMPORT + PUBLISHED)
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    assert analysis.diagnostics == ()


def test_both_forms_may_stand_in_one_file() -> None:
    declarations = split("bdd", PUBLISHED)
    mixed = "".join(
        (current if index % 2 else published).text
        for index, (current, published) in enumerate(zip(split("bdd", CURRENT), declarations, strict=True))
    )
    assert graph(mixed) == graph(CURRENT)


def in_scene(scene: str) -> tuple[list[str], str]:
    """The findings about a scene beyond its models, and the graph of a model that imports it."""
    case = fixture(f"//- main.bdd\n{MODEL}//- lab.scene\n{scene}")
    found = [entry for uri in case.project.texts() for entry in fast_diagnostics(case.snapshot, uri)]
    ttl = serialize(build_graph(case.snapshot, case.uri).graph, "ttl")
    return [entry.code for entry in found if entry.code not in ("catalog-models", "no-model")], ttl


def test_scenes_leave_their_namespace_out_as_well() -> None:
    _, expected = in_scene(SCENE)
    declared = SCENE.count(" (ns=env)")
    assert in_scene(SCENE.replace(" (ns=env)", "")) == (["published-form"] * declared, expected)
    pieces = SCENE.split(" (ns=env)")
    for number in range(1, declared + 1):
        mixed = " (ns=env)".join(pieces[:number]) + " (ns=env)".join(pieces[number:])
        assert in_scene(mixed) == (["published-form"], expected)


def test_with_several_namespaces_a_scene_must_say_which() -> None:
    codes, _ = in_scene("ns o = 'https://example.org/o/'\n" + SCENE.replace("comp (ns=env) tray", "comp tray"))
    assert codes == ["namespace-missing"]


def test_clauses_without_names_are_numbered_past_the_names_that_are_given() -> None:
    clauses = "fetch-given-1: holds(<part> is located at <goal>, before <start>) <robot> can reach <part> before <end>"
    case = fixture(MODEL.replace("on-bench: holds(<part> is located at <goal>, before <pick-start>)", clauses))
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    assert {"fetch.fetch-given-1", "fetch.fetch-given-2"} <= set(analysis.definitions)
    assert analysis.diagnostics == ()


def test_clauses_inside_expressions_are_named_too() -> None:
    text = """Scenario Template x {
        Given: ( not <a> can reach <b> before <e> )
        for all ( var y in <ys> ) {
            Given: ( <a> can reach <y> before <e> or <a> can reach <b> before <e> )
            When: <a> picks <y>
        }
        Then: ( var z exists in <ys> ) such that { <a> can reach <z> after <e> }
    }"""
    names = [symbol.path for symbol in parse_declaration("bdd", text).symbols if symbol.kind == "fluent"]
    assert names == ["x.x-given-1", "x.x-each-given-1", "x.x-each-given-2", "x.x-then-1"]


PICKS_AND_PLACES = "Given: <a> can reach <b> before <s> When: <a> picks <b> and places it at <c> Then:"


@pytest.mark.parametrize(
    ("clauses", "duration"),
    [
        ("Given: <a> can reach <b> before <s> When: <a> picks <b> Then: <a> can reach <b> after <t>", ("s", "t")),
        ("When: <a> picks <b> Then: <a> can reach <b> from <s> until <t>", ("s", "t")),
        ("When: <a> picks <b> from <s> until <t> Then: <a> can reach <b> after <u>", ("s", "t")),
        ("When: <a> picks <b> Then: <a> can reach <b> after <t>", None),
        # The end of picking is not the end of the behaviour, whatever the order of the clauses.
        (f"{PICKS_AND_PLACES} <b> is held by <a> after <pickup_end> <b> is located at <c> after <done>", ("s", "done")),
        (
            f"{PICKS_AND_PLACES} <b> is held by <a> after <held> <b> is located at <c> after <place_end>",
            ("s", "place_end"),
        ),
        (f"{PICKS_AND_PLACES} <b> is held by <a> after <held> <b> is located at <c> after <done>", None),
        (f"{PICKS_AND_PLACES} <b> is held by <a> after <pick_end>", None),
        (
            "Given: <a> can reach <b> before <r> <a> can reach <b> before <pick_start> When: <a> picks <b> "
            "Then: <a> can reach <b> after <t>",
            ("pick_start", "t"),
        ),
    ],
)
def test_a_behaviour_lasts_as_its_clauses_tell(clauses: str, duration: tuple[str, str] | None) -> None:
    root = parse_declaration("bdd", f"Scenario Template x {{ {clauses} }}").tree
    assert isinstance(root, tree.Template)
    found = next(root.body.behaviours).duration
    assert (found and (found.start.path, found.end.path)) == duration


def test_a_published_scenario_lasts_as_its_behaviour() -> None:
    clauses = "When: {} Then: <a> can reach <b> from <s> until <t> }}"
    for head, behaviour, told in (
        ("x", "<a> picks <b>", True),
        ("(ns=t) x", "<a> picks <b>", True),
        ("x", "Behaviour b { <a> picks <b> }", True),
        ("(ns=t) x", "Behaviour (ns=t) b { <a> picks <b> }", False),
    ):
        root = parse_declaration("bdd", f"Scenario Template {head} {{ {clauses.format(behaviour)}").tree
        assert isinstance(root, tree.Template)
        assert (root.duration is not None) == told


def test_an_event_that_tells_a_duration_is_one_reference() -> None:
    references = parse_declaration("bdd", split("bdd", PUBLISHED)[3].text).references
    assert len({reference.ref.span for reference in references}) == len(references)


def test_other_phrases_of_a_word_have_its_slots_and_are_read_as_it() -> None:
    catalog = load_catalog()
    aliases = [(word, alias) for word in catalog.behaviours.values() for alias in word.aliases]
    assert aliases
    for word, alias in aliases:
        root = parse_declaration("bdd", f"Scenario Template x {{ When: {alias} }}").tree
        assert isinstance(root, tree.Template)
        action = next(root.body.behaviours).action
        assert action.word == word.name
        assert {name for name, _ in action.arguments} == {slot.name for slot in word.slots}


def test_a_scenario_may_be_called_variant() -> None:
    story = MODEL[MODEL.index("User Story") :].replace("Scenario bench-to-tray", "Scenario Variant")
    root = parse_declaration("bdd", story).tree
    assert isinstance(root, tree.Story)
    assert root.variants[0].name.text == "Variant"


def check(text: str) -> None:
    case = fixture(text)
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    assert_diagnostics(list(analysis.diagnostics), case)


def test_without_any_namespace_a_declaration_needs_one() -> None:
    check("Event start\n//    ^^^^^ namespace-missing declare one, such as ns t =\n")


def test_with_several_namespaces_a_declaration_must_say_which() -> None:
    text = "ns t = 'https://example.org/t/'\nns u = 'https://example.org/u/'\nEvent start\n"
    check(text + "//    ^^^^^ namespace-missing write '(ns=t)'\n")
    case = fixture(text)
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    (found,) = analysis.diagnostics
    (edit,) = found.fixes[1].edits
    fixed = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert "Event (ns=u) start" in fixed
    check(fixed)


def test_a_namespace_of_an_imported_file_is_not_the_files_own() -> None:
    check(SCENE_IMPORT + "Event start\n//    ^^^^^ namespace-missing\n")


def test_an_unknown_listed_value_is_reported_in_its_place() -> None:
    check(
        SCENE_IMPORT
        + PUBLISHED.replace(
            "- obj <parts.nut>\n",
            "- obj <places.tray_ws>\n//                 ^^^^^^^^^^^^^^ wrong-kind an object belongs here\n",
        )
    )


def test_an_unknown_variable_of_a_list_is_looked_for_in_the_template() -> None:
    check(
        SCENE_IMPORT
        + PUBLISHED.replace(
            "        <goal> can be:", "        <gaol> can be:\n//       ^^^^ unknown-name did you mean 'fetch.goal'\n"
        )
    )


def test_the_node_of_a_behaviour_tree_is_linked() -> None:
    linked = TEMPLATE.replace(
        "places at <goal>\n        }", "places at <goal>\n            node: <handling.pick>\n        }"
    )
    assert linked != TEMPLATE
    declared = "Behaviour Tree (ns=t) handling { py { module: my_pkg.trees, attr: create } node pick node place }\n"
    check(EVENTS + declared + linked)
    check(
        EVENTS
        + declared
        + linked.replace("handling.pick>\n", "handling.pack>\n//                 ^^^^^^^^^^^^^ unknown-name\n")
    )


def test_as_a_i_want_so_that_are_written_together_or_not_at_all() -> None:
    declaration = parse_declaration("bdd", 'User Story (ns=t) s { As A "x" Scenarios: }')
    assert declaration.faults[0].message == "unexpected 'Scenarios': expected 'I'"
