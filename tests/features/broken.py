"""Small models, each with a mistake for which a fix is offered, by the code of the finding."""

from __future__ import annotations

from checks.models import LINES, SETS, story
from checks.test_behaviour_tree import TREE, linked
from checks.test_behaviour_tree import other as another
from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE
from syntax.test_published import PUBLISHED, SCENE_IMPORT

_TWO_NAMESPACES = EVENTS.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =")
_OTHER = (
    TEMPLATE.replace("fetch", "bring")
    .replace("carry", "haul")
    .replace("on-bench", "at-b")
    .replace("in-tray", "at-t")
    .replace("Template (ns=t)", "Template (ns=o)")
)
_HEADER = "                | <fetch.part> | <fetch.robot> | <fetch.goal> |\n                |---|\n"
_ROW = "                | <parts.bolt> | <arms.panda> | <places.tray_ws> |\n"
_LISTED = "                | <parts.bolt> | <arms.panda> | { <places.tray_ws>,\n                <places.bench_ws> } |\n"
_SPARE = TEMPLATE.replace("    var goal\n", "    var goal\n    var spare\n")
_SHELF = (
    "//- lab.scene\n"
    + SCENE.replace("object bench,", "object bench, object shelf,").replace(
        "tray_ws }", "tray_ws, workspace shelf_ws }", 1
    )
    + "scene (ns=env) inner_scene {\n    obj set <parts>\n    agn set <arms>\n    ws set <places>  // all of them\n}\n"
)
_ELSEWHERE = "//- more.scene\nns x = 'https://example.org/x/'\nagn set (ns=x) robots { agent r2 }\n"
_EXECUTABLE = "//- main.scenex\nimport \"lab.scene\"\nns x = 'https://example.org/x/'\n"


_EXECUTED = """//- main.bddx
import "main.bdd"
import "lab.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) built-in { catalog "pick-place" }
Scenario Exec (ns=x) once {
    variant: <fetching.bench-to-tray>
    scene inst: <models>
    bhv: <built-in>
}
//- lab.scenex
import "lab.scene"
ns s = 'https://example.org/s/'
scene inst (ns=s) models { scene: <bench_scene> }
"""


_REPEATED = (
    EVENTS
    + TREE
    + "Scenario Template (ns=t) fetch { duration: from <start> until <end> task: <task> set var parts var robot\n"
    + "for all ( var part in <parts> ) { When: Behaviour (ns=t) carry { duration: from <pick-start> until <place-end>\n"
    + "<robot> picks <part>\n node: <handling.pick>\n } } }\n"
)


def _without(*lines: str) -> str:
    """The model without some lines."""
    text = MODEL
    for line in lines:
        assert line in text
        text = text.replace(line, "")
    return text


def _swapped(*pairs: str) -> str:
    """The model with some texts, each of which it contains, replaced."""
    text = MODEL
    for old, new in zip(pairs[::2], pairs[1::2], strict=True):
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def _declared(line: str) -> str:
    """The model with one more declaration before its templates."""
    return EVENTS + line + TEMPLATE + STORY


def _paced(setting: str) -> str:
    """A template that sets a configuration to the value of one more variable, ``pace``."""
    return TEMPLATE.replace("    var goal\n", "    var goal\n    var pace\n").replace(
        "    Then:\n", f"    Then:\n        slow: holds(<robot> has config {setting} = <pace>, after <end>)\n"
    )


_IN_TRAY = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
_LOOP = "for all ( var part in <parts> ) "
_MORE = "Behaviour (ns=t) more { duration: from <pick-start> until <place-end> <robot> picks <part> }"
_TILTED = (
    EVENTS
    + TEMPLATE.replace("<part> is located at <goal>, 0.5", "<part> is tilted less than <most>, 0.5").replace(
        "var goal", "var goal var most"
    )
    + STORY.replace("var <fetch.robot>:", "var <fetch.most>: { MOST } var <fetch.robot>:")
)
BROKEN: dict[str, list[str]] = {
    "syntax": [
        _swapped("before <pick", "befor <pick"),
        _swapped("var robot", "vr robot"),
        _swapped("When:", "When"),
        _swapped("<robot> picks", "<robot picks"),
        _swapped("Then:", "Than:"),
        _swapped("<fetch.part>: obj set", "<fetch.part> obj set"),
        _swapped("    }\n}", "    }\n"),
        "//- lab.scene\n" + SCENE.replace("workspace bench_ws,", "workspac bench_ws,"),
        "//- lab.scene\n" + SCENE.replace("object bolt, object", "object bolt object"),
    ],
    "quantity": [
        _swapped("<part> is located at <goal>, 0.5", "<part> is tilted less than 5 cm, 0.5"),
        _swapped("<part> is located at <goal>, 0.5", "<robot> presses <part> with less than .5e1m/s, 0.5"),
        _TILTED.replace("MOST", "5 m"),
    ],
    "unknown-name": [
        _swapped("before <pick-start>", "before <pik-start>"),
        _swapped("before <pick-start>", "before <lift>"),
        _swapped("scene: <bench_scene>", "scene: <bench-scene>"),
        _swapped("task: <task>", "task: <other>"),
        EVENTS + TEMPLATE.replace("<robot> picks", "<crane> picks"),
        _swapped("<places.tray_ws>", "<places.trays_ws>"),
        "//- main.bdd\n" + _without('import "lab.scene"\n'),
        "//- main.bdd\n" + _swapped("<arms.panda>", "<robots.r2>") + _ELSEWHERE,
        EVENTS
        + "Scenario Template (ns=t) other { task: <task> var a When: event <lift> occurs <a> picks <a> }\n"
        + TEMPLATE
        + STORY,
        EVENTS + " ".join(TEMPLATE.replace("<robot> picks", "<crane> picks").split()),
        "ns t = 'https://example.org/t/'\n"
        "Scenario Template (ns=t) x { duration: from <go> until <stop> var a var b When: <a> picks <b> }\n",
    ],
    "wrong-kind": [
        _swapped("<arms.panda>", "<arms>"),
        _swapped("obj set <parts>", "ws set <parts>"),
        "//- lab.scene\n" + SCENE.replace("agn set <arms> }", "obj set <arms> }"),
        "//- lab.scene\n" + SCENE.replace("ws comp <tray_comp> }\nscene", "ws <tray_comp> }\nscene"),
    ],
    "namespace-missing": [
        _TWO_NAMESPACES + "Event late\n" + TEMPLATE + STORY,
        _TWO_NAMESPACES + TEMPLATE.replace("Template (ns=t)", "Template") + STORY,
        _TWO_NAMESPACES + TEMPLATE + STORY.replace("Story (ns=t)", "Story"),
        "//- lab.scene\nns o = 'https://example.org/o/'\n" + SCENE.replace("comp (ns=env) tray", "comp tray"),
        "//- lab.scene\nns o = 'https://example.org/o/'\n" + SCENE.replace("obj set (ns=env)", "obj set"),
    ],
    "property-condition": [
        "//- lab.scene\n"
        + SCENE.replace("bolt, object nut", "bolt { colour: red }, object nut { colour: blue }").replace(
            "tray_ws }", f"tray_ws {{ correct for: obj set <parts> where {condition} }} }}", 1
        )
        for condition in ("color = red", "colour = rad")
    ],
    "property-value": [
        "//- lab.scene\n" + SCENE.replace("object nut", "object nut { colour: red  size: 3  colour: blue, red }"),
        "//- lab.scene\n" + SCENE.replace("object nut", "object nut { colour: red colour: red size: 3 }"),
    ],
    "table-column": [
        "//- lab.scene\n"
        + SCENE.replace("bolt, object nut", "bolt { colour: red }, object nut { mass: 3 g }").replace(
            "obj set <parts> ws", f"obj set <parts> with {columns} ws"
        )
        for columns in ("color", "mass, color")
    ],
    "published-form": [SCENE_IMPORT + PUBLISHED, _declared("Event spare\n")],
    "repeated-value": [
        story(LINES + "                var <fetch.part>: { <parts.bolt> }\n"),
        story(LINES.rstrip() + " var <fetch.part>: { <parts.bolt> } // again\n"),
        story(LINES + "                var <fetch.part>: { <parts.bolt>,\n    <parts.nut> }\n"),
        story(
            _HEADER.replace("> |\n", "> | <fetch.part> |\n").replace("|---|", "|---|---|---|-----|")
            + _ROW.replace("ws> |", "ws> | <parts.nut> |")
        ),
        story(
            _HEADER.replace("| <fetch.robot>", "| <fetch.part> | <fetch.robot>")
            + _ROW.replace("| <arms", "|\n { 3, 'a|b' }\n | <arms")
        ),
    ],
    "foreign-variable": [
        _TWO_NAMESPACES + TEMPLATE + _OTHER + STORY.replace("<fetch.part>:", "<bring.part>:"),
        _TWO_NAMESPACES
        + TEMPLATE
        + _OTHER
        + STORY.replace(
            "variation:", "Then: also: holds(<bring.part> is held by <fetch.robot>, after <end>)\n variation:"
        ),
    ],
    "row-width": [
        story(_HEADER + _ROW + "                | <parts.nut> | <arms.ur10> |\n"),
        story(_HEADER + "                | <parts.nut> |\n" + _LISTED),
        story(_HEADER + _ROW + "                | <parts.nut>\n | <arms.ur10>\n |\n"),
        story(_HEADER + "                | <parts.nut> | <arms.ur10> | <places.tray_ws> | 3 | 4 |\n"),
        story(_HEADER + _LISTED.replace("} |", "} | 'a | b' |") + _ROW),
        story(_HEADER + "                | <parts.nut> |\n"),
    ],
    "type-conflict": [
        _swapped("in-tray: holds(<part>", "in-tray: holds(<robot>"),
        _swapped("at <goal>, 0.5", "at <robot>, 0.5"),
        _swapped("obj set <parts>", "{ <parts.bolt>, <arms.ur10> }"),
        _swapped("obj set <parts>", "ws set <places>"),
        _swapped("{ <arms.panda> }", "{ 3 }"),
        _swapped("variation:", "Then: held: holds(<fetch.goal> is held by <fetch.robot>, after <end>)\n variation:"),
        story(_HEADER + _ROW.replace("<parts.bolt>", "<arms.ur10>") + _ROW.replace("<parts.bolt>", "ws set <places>")),
        story(LINES + "                set var <fetch.goals>: select 1 combinations from <arms>\n", SETS),
        EVENTS + SETS.replace("in <goals>", "in <arms>"),
        _TILTED.replace("MOST", "5"),
    ],
    "not-in-scene": [
        "//- main.bdd\n" + _swapped("<places.tray_ws>", "<places.shelf_ws>") + _SHELF,
        "//- main.bdd\n"
        + _swapped("obj set <parts>", "{ <furniture.shelf> }").replace("bench_scene", "inner_scene")
        + _SHELF,
        "//- main.bdd\n"
        + _swapped("obj set <parts>", "set <things>")
        .replace("Event", "const set (ns=t) things { <tools.saw> }\nEvent", 1)
        .replace("import", 'import "more.scene"\nimport', 1)
        + _SHELF
        + "//- more.scene\nns m = 'https://example.org/m/'\nobj set (ns=m) tools { object saw }\n",
    ],
    "duplicate-iri": [
        _TWO_NAMESPACES + TEMPLATE + _OTHER.replace("at-b:", "on-bench:").replace("(ns=o)", "(ns=t)") + STORY,
        "//- main.bdd\nimport 'm.bdd'\n" + MODEL + "//- m.bdd\nns m = 'https://example.org/t/'\nEvent (ns=m) end\n",
    ],
    "cyclic-import": [
        "//- main.bdd\nimport 'm.bdd'\n" + MODEL + "//- m.bdd\nimport 'main.bdd'\n",
        "//- main.bdd\nimport 'm.bdd'\n"
        + MODEL.replace("task: <task>", "task: <idle>")
        + "//- m.bdd\nimport 'main.bdd'\nns m = 'https://example.org/m/'\nTask (ns=m) idle\n",
    ],
    "import": [
        "//- main.bdd\nimport 'm.bdd'\n" + MODEL,
        "//- main.bdd\nimport 'main.bdd'\n" + MODEL,
        "//- lab.scene\nimport 'main.bdd'\n" + SCENE + "//- main.bdd\n" + MODEL,
    ],
    "empty-set": [
        _swapped("{ <arms.panda> }", "{ }"),
        story(_HEADER + _ROW.replace("<arms.panda>", "{ }")),
        story(LINES + "                set var <fetch.goals>: { }\n", SETS),
        story(LINES + "                set var <fetch.goals>: { { <places.tray_ws> }, {} }\n", SETS),
        _declared("const set (ns=t) none { }\n").replace("obj set <parts>", "set <none>"),
    ],
    "empty-duration": [
        _swapped("0.5 seconds after <place-end>)", "from <place-end> until <place-end>)"),
        _swapped("variation:", "Then: 'all is well' from <end>  until <end>\n variation:"),
        _swapped("from <pick-start> until <place-end>", "from <end> until <end>"),
        _swapped("from <start> until <end>", "from <start> until <start>"),
    ],
    "distribution": [
        _EXECUTABLE + "distrib (ns=x) d { uniform { dimension: 2 lower: (0, 0, 0) upper: (1, 1, 1) } }\n",
        _EXECUTABLE + "distrib (ns=x) d { normal { dimension: 2 mean: (0, 0, 0) std-dev: 1 } }\n",
        _EXECUTABLE + "distrib (ns=x) d { uniform { dimension: 2 lower: (0, 2) upper: (1, 1.5) } }\n",
        _EXECUTABLE + "distrib (ns=x) d { uniform { dimension: 1 lower: 2 upper: 1e-1 } }\n",
    ],
    "selection-size": [
        story(LINES + "                set var <fetch.goals>: select 0 permutations from <places>\n", SETS),
        *(
            story(LINES + f"                set var <fetch.goals>: select 3 {kind} from <places>\n", SETS)
            for kind in ("combinations", "permutations")
        ),
    ],
    "setting": [
        story(LINES + "                var <fetch.pace>: { 0.5 }\n", _paced("max_sped")),
        story(LINES + "                var <fetch.pace>: { 0.5, 50 }\n", _paced("max_speed")),
        story(LINES + "                var <fetch.pace>: { -1.5 }\n", _paced("seed")),
    ],
    "catalog-entry": [
        _EXECUTABLE
        + 'scene inst (ns=x) s { scene: <bench_scene> obj <parts.bolt> { model m as mjcf { catalog "cubee" } } }\n',
        "//- main.bddx\nns x = 'https://example.org/x/'\nbhv impl (ns=x) b { catalog \"pick-plac\" }\n",
    ],
    "no-emitter": [
        MODEL.replace("after <place-end>)", "after <parked>)").replace(
            "Event (ns=t) end", "Event (ns=t) parked\nEvent (ns=t) end"
        ),
    ],
    "no-evaluator": [
        _swapped("<part> is located at <goal>, 0.5", "pred('{o} is up', o=<part>), 0.5"),
        _swapped(
            "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)", "'It is up' after <end>"
        ),
        "//- main.bdd\n" + _swapped("<part> is located at <goal>, 0.5", "pred('{o} is up', o=<part>), 0.5") + _EXECUTED,
    ],
    "no-model": [
        MODEL.replace("parts.nut", "parts.gizmo") + "//- lab.scene\n" + SCENE.replace("object nut", "object gizmo"),
        "//- lab.scene\n" + SCENE.replace("agent panda", "agent robot"),
    ],
    "contradictory-order": [
        _swapped("0.5 seconds after <place-end>)", "from <place-end> until <pick-start>)"),
        _swapped(
            "variation:",
            "Then: late: holds(<fetch.part> is held by <fetch.robot>, from <end> until <start>)\n variation:",
        ),
    ],
    "unused-event": [
        _declared("Event (ns=t) spare\n"),
        _declared("Event (ns=t) spare Event (ns=t) spare-too\n"),
        _declared("Event\n (ns=t)\n spare // not needed\n"),
    ],
    "behaviour-tree": [
        EVENTS + TREE + linked("pick") + another(TEMPLATE) + STORY,
        EVENTS + TREE.replace("        node place\n", "") + linked("pick") + another(linked("pick")) + STORY,
        _REPEATED,
    ],
    "namespace-iri": [MODEL.replace("'https://example.org/t/'", "'t'"), MODEL.replace("https://example.org/t/", "a b")],
    "missing-value": [
        _without("                var <fetch.robot>: { <arms.panda> }\n"),
        _without(
            "                var <fetch.robot>: { <arms.panda> }\n",
            "                var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }\n",
        ),
        story("                | <fetch.part> | <fetch.robot> |\n |---|\n | <parts.nut> | <arms.panda> |\n"),
        story(
            "                | <fetch.part>\n|\n |-----|\n | <parts.nut> | |\n<parts.bolt>\n |\n".replace(
                "| |\n", "|\n|"
            )
        ),
        story("                | <fetch.robot> | <fetch.part> | <fetch.goal> |\n |---|\n", SETS),
    ],
    "duplicate-name": [
        _declared("Event (ns=t) start\n"),
        _swapped("in-tray", "on-bench"),
        EVENTS + TEMPLATE.replace("    var goal\n", "    var goal\n    var goal\n") + STORY,
        EVENTS + TEMPLATE.replace("    var goal\n", "    var goal var part var part\n") + STORY,
        "//- lab.scene\n" + SCENE.replace("object nut", "object nut, object nut, object nut-2"),
    ],
    "catalog-phrase": [
        _swapped(
            _IN_TRAY, 'in-tray: holds(pred("{one} is located at {where}", one=<part>, where=<goal>), after <place-end>)'
        ),
    ],
    "hidden-variable": [
        _swapped(_IN_TRAY, f"( var goal exists in <places> ) such that {{ {_IN_TRAY} }}"),
        _swapped("    Then:\n", f"    {_LOOP}{{ {_LOOP}{{ When: {_MORE} }} }}\n    Then:\n"),
        _swapped(
            "scene: <bench_scene>\n",
            "scene: <bench_scene>\n            Then: ( var part exists in <parts> ) such that { ( "
            "one: holds(<part> is located at <fetch.goal>, after <end>) and "
            "two: holds(<fetch.part> is located at <fetch.goal>, after <end>) ) }\n",
        ),
    ],
    "unused-predicate": [_declared("Predicate (ns=t) <one> is-put at <place>: ( <one> is located at <place> )\n")],
    "unused-task": [_declared("Task (ns=t) spare\n")],
    "unused-set": [
        _declared("const set (ns=t) spare { <parts.bolt> }\n"),
        _declared("const set (ns=t) spare {\n1,\n2 }\n"),
    ],
    "unused-import": [
        "//- main.bdd\nimport 'more.scene'\n" + MODEL + _ELSEWHERE,
        "//- main.bdd\nimport 'more.scene' " + MODEL + _ELSEWHERE,
    ],
    "unused-variable": [
        EVENTS + TEMPLATE.replace("    var goal\n", "    var goal\n    var spare\n") + STORY,
        EVENTS + TEMPLATE.replace("    var goal\n", "    var goal set var spare var more\n") + STORY,
        story(LINES + "                var <fetch.spare>: { 1, 2 }\n", _SPARE),
        story("                var <fetch.spare>: { 1 } var <fetch.robot>: obj set <arms>\n", _SPARE),
        story(
            _HEADER.replace("| <fetch.part>", "| <fetch.spare> | <fetch.part>")
            + _ROW.replace("| <parts", "| 1 | <parts"),
            _SPARE,
        ),
    ],
    "named-predicate": [
        MODEL.replace(
            "Scenario Template", "Predicate (ns=t) <a> is-put in <b>: <a> is located at <b>\nScenario Template", 1
        ).replace("holds(<part> is located at <goal>, 0.5", "holds(<part> is-put at <goal>, 0.5"),
    ],
    "emission": [
        MODEL.replace("places at <goal>\n", "places at <goal>\n            emits pick-ends as <pick-start>\n"),
    ],
    "simultaneous-agent": [
        MODEL.replace(
            "places at <goal>\n        }\n",
            "places at <goal>\n        }\n        meanwhile Behaviour (ns=t) more {\n"
            "            duration: from <pick-start> until <place-end> <robot> picks <part>\n        }\n",
        ),
    ],
    "number-range": [
        "//- main.bddx\nns x = 'https://example.org/x/'\n"
        "obs provider (ns=x) p { simulation ground truth update-rate: 9 Hz\n    noise: -2 mm }\n",
    ],
    "not-simulated": [
        "//- main.bddx\nns x = 'https://example.org/x/'\nbhv impl (ns=x) b {\n    bhv action: \"/a\" }\n",
        '//- main.bddx\nns x = \'https://example.org/x/\'\nobs provider (ns=x) p { ros topic: "/p"\n    type: "m" }\n',
    ],
    "execution-fit": [
        _EXECUTED.replace('"pick-place"', '"pick"').replace("//- lab.scenex", f"//- main.bdd\n{MODEL}//- lab.scenex"),
    ],
}
"""Diagnostic code → fixtures (see ``kit.fixture``) that have at least one such finding with a fix."""
