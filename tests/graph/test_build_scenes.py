"""Elements, sets, compositions, scenes and membership become the published triples."""

from graph.statements import built, of, statements
from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE

HEAD = "ns env = 'https://example.org/env/'\n"
ONLY_SCENE = f"//- lab.scene\n{SCENE}"


def test_elements_have_the_class_of_their_set() -> None:
    found = statements(built(ONLY_SCENE).graph)
    assert {"lab:bolt a env:Object", "lab:bench_ws a env:Workspace", "lab:panda a agn:Agent"} <= found


def test_a_set_has_its_elements_once_in_any_order_and_once_in_the_written_one() -> None:
    assert of(built(ONLY_SCENE).graph, "lab:arms") == [
        "a bdd:ConstantSet",
        "a bdd:Set",
        "bdd:elements lab:panda",
        "bdd:elements lab:ur10",
        "rbw:element-list (lab:panda lab:ur10)",
    ]


def test_a_similar_set_stands_for_numbered_elements() -> None:
    graph = built(ONLY_SCENE).graph
    assert "rbw:element-list (lab:washer0 lab:washer1 lab:washer2)" in of(graph, "lab:washers")
    assert of(graph, "lab:washer2") == ["a env:Object"]


def test_a_composition_holds_objects_and_the_workspaces_of_nested_compositions() -> None:
    assert of(built(ONLY_SCENE).graph, "lab:bench_comp") == [
        "a env:WorkspaceHasObject",
        "a env:WorkspaceHasWorkspace",
        "env:has-object lab:bench",
        "env:has-workspace lab:tray_ws",
        "env:of-workspace lab:bench_ws",
        "rbw:entries (lab:bench lab:tray_comp)",
    ]


def test_a_composition_may_come_before_what_it_nests() -> None:
    later = SCENE.replace("comp (ns=env) tray_comp of ws <places.tray_ws> { obj <furniture.tray> }\n", "")
    later += "comp (ns=env) tray_comp of ws <places.tray_ws> { obj <furniture.tray> }\n"
    assert statements(built(f"//- lab.scene\n{later}").graph) == statements(built(ONLY_SCENE).graph)


def test_two_compositions_of_one_workspace_keep_all_their_objects() -> None:
    scene = HEAD + (
        "obj set (ns=env) shared { object leg, object top }\nws set (ns=env) places { workspace desk }\n"
        "comp (ns=env) first of ws <places.desk> { obj <shared.leg> }\n"
        "comp (ns=env) second of ws <places.desk> { obj <shared.leg> obj <shared.top> }\n"
        "scene (ns=env) office { ws comp <first> ws comp <second> }\n"
    )
    variant = STORY.replace("bench_scene", "office").replace("obj set <parts>", "obj set <shared>")
    variant = variant.replace("<arms.panda>", "3").replace("<places.bench_ws>, <places.tray_ws>", "<places.desk>")
    graph = built(f"//- main.bdd\n{EVENTS}{TEMPLATE}{variant}//- lab.scene\n{scene}").graph
    assert "rbw:member-list (lab:leg lab:top)" in of(graph, "lab:office-scene-has-obj")


def test_a_scene_tells_what_it_was_put_together_from() -> None:
    assert of(built(ONLY_SCENE).graph, "lab:bench_scene") == [
        "a bdd:Scene",
        "rbw:entries (lab:parts lab:bench_comp lab:tray_comp lab:arms)",
    ]


def test_the_members_of_a_variant_belong_to_the_scene_of_its_template() -> None:
    graph = built(MODEL).graph
    assert of(graph, "lab:bench_scene-scene-has-obj") == [
        "a bdd:SceneHasObjects",
        "bdd:of-scene t:fetch-scene",
        "env:has-object lab:bench",
        "env:has-object lab:bolt",
        "env:has-object lab:nut",
        "env:has-object lab:tray",
        "rbw:member-list (lab:bolt lab:nut lab:bench lab:tray)",
    ]
    assert "rbw:member-list (lab:bench_ws lab:tray_ws)" in of(graph, "lab:bench_scene-scene-has-ws")
    assert "rbw:member-list (lab:panda lab:ur10)" in of(graph, "lab:bench_scene-scene-has-agn")


def second_variant(**changes: str) -> str:
    """The story with a second variant that differs from the first by the given replacements."""
    start = STORY.index("        Scenario ")
    copy = STORY[start : STORY.rindex("}")].replace("bench-to-tray", "second")
    for old, new in changes.items():
        copy = copy.replace(old, new)
    return STORY[: STORY.rindex("}")] + copy + "}\n"


def test_two_variants_with_the_same_members_share_the_membership_nodes() -> None:
    graph = built(EVENTS + TEMPLATE + second_variant()).graph
    assert of(graph, "lab:bench_scene-scene-has-obj") == of(built(MODEL).graph, "lab:bench_scene-scene-has-obj")
    expected = "bdd:has-scene lab:bench_scene-scene-has-obj"
    assert expected in of(graph, "t:bench-to-tray")
    assert expected in of(graph, "t:second")


def test_two_templates_that_use_one_scene_have_membership_nodes_of_their_own() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("on-bench", "on-b").replace("in-tray", "in-t")
    graph = built(EVENTS + TEMPLATE + other + second_variant(fetch="bring")).graph
    assert "bdd:has-scene lab:bench_scene-scene-has-obj" in of(graph, "t:bench-to-tray")
    assert "bdd:has-scene lab:bench_scene-scene-has-obj-2" in of(graph, "t:second")
    assert "bdd:of-scene t:fetch-scene" in of(graph, "lab:bench_scene-scene-has-obj")
    assert "bdd:of-scene t:bring-scene" in of(graph, "lab:bench_scene-scene-has-obj-2")


def test_what_one_variation_brings_along_does_not_leak_into_the_scene_of_another() -> None:
    graph = built(EVENTS + TEMPLATE + second_variant(**{"obj set <parts>": "obj set <washers>"})).graph
    assert "rbw:member-list (lab:bolt lab:nut lab:bench lab:tray)" in of(graph, "lab:bench_scene-scene-has-obj")
    assert "rbw:member-list (lab:bolt lab:nut lab:bench lab:tray lab:washer0 lab:washer1 lab:washer2)" in of(
        graph, "lab:bench_scene-scene-has-obj-2"
    )
    assert "bdd:has-scene lab:bench_scene-scene-has-obj-2" in of(graph, "t:second")


def test_imports_contribute_only_what_the_file_leads_to() -> None:
    found = statements(built(MODEL).graph)
    assert "lab:washers a bdd:Set" not in found
    assert "lab:washers a bdd:Set" in statements(built(MODEL.replace("obj set <parts>", "obj set <washers>")).graph)
