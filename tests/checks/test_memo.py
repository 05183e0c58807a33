"""Findings that were kept equal those of a fresh analysis, wherever an edit has moved them."""

from collections.abc import Callable
from random import Random

import pytest

from checks.models import LINES, story
from kit import FOLDER, MODEL, SCENE, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.checks import memo
from robbdd_tools.checks.file_caches import without_cache
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
from robbdd_tools.names.elements import Site
from robbdd_tools.names.project import Project, Snapshot

URI = f"{FOLDER}main.bdd"
FAULTY = story(LINES.replace("{ <arms.panda> }", "{ <places.tray_ws> }") + "var <fetch.part>: { }\n")
SCENARIO = STORY[STORY.index("        Scenario bench") : STORY.rindex("}")]
FAULTY_SCENARIOS = MODEL.replace(
    SCENARIO,
    SCENARIO
    + SCENARIO.replace("bench-to-tray", "idle").replace("{ <arms.panda> }", "{ <places.tray_ws> }")
    + SCENARIO.replace("bench-to-tray", "poor").replace("var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }", "")
    + " ".join(SCENARIO.replace("bench-to-tray", "short").replace("var <fetch.part>: obj set <parts>", "").split())
    + SCENARIO.replace("bench-to-tray", "asking").replace(
        "            variation:",
        "            Then: ( var thing exists in <fetch.goal> ) such that\n"
        "                { lies: holds(<thing> is held by <fetch.robot>, from <end> until <end>) }\n"
        "            variation:",
    ),
)
"""A story whose scenarios have a finding each."""


def project(scene: str = SCENE) -> Project:
    made = Project()
    made.open(f"{FOLDER}lab.scene", 1, scene)
    return made


def cold(text: str, scene: str = SCENE) -> list[Diagnostic]:
    """Analyse a text with empty caches; restore the caches afterwards."""
    fresh = project(scene)
    fresh.open(URI, 1, text)
    with without_cache():
        return fast_diagnostics(fresh.snapshot(), URI)


EDITS: list[tuple[str, Callable[[str], str]]] = [
    ("a new line before everything", lambda text: "\n\n" + text),
    ("an event renamed", lambda text: text.replace("Event (ns=t) end", "Event (ns=t) finish")),
    ("a phrase of the template", lambda text: text.replace("<robot> picks", "<part> picks")),
    ("a variable more", lambda text: text.replace("var goal\n", "var goal\n    var extra\n")),
    ("a declaration that takes a name away", lambda text: "Event (ns=t) fetch\n" + text),
    ("the story twice", lambda text: text + text[text.index("User Story") :]),
    ("the template after the story", lambda text: text.replace(TEMPLATE, "") + TEMPLATE),
    ("a broken template", lambda text: text.replace("task: <task>", "task <task>")),
    ("no import", lambda text: text.replace('import "lab.scene"', "")),
    ("no namespace named", lambda text: text.replace("(ns=t) ", "")),
    ("two namespaces for those who name none", lambda text: "ns o = 'https://o/'\n" + text.replace("(ns=t) ", "")),
    ("another namespace", lambda text: text.replace("https://example.org/t/", "https://example.org/env/")),
    ("a namespace of another name", lambda text: text.replace("ns t =", "ns u =")),
]


@pytest.mark.parametrize("edit", [edit for _, edit in EDITS], ids=[name for name, _ in EDITS])
@pytest.mark.parametrize("text", [MODEL, FAULTY, FAULTY_SCENARIOS], ids=["sound", "faulty", "faulty scenarios"])
def test_an_edit_and_its_undoing_give_what_a_fresh_analysis_gives(text: str, edit: Callable[[str], str]) -> None:
    warm = project()
    found: list[list[Diagnostic]] = []
    for version, state in enumerate((text, edit(text), text, edit(text))):
        warm.open(URI, version, state)
        found.append(fast_diagnostics(warm.snapshot(), URI))
    assert found[0] == found[2] == cold(text)
    assert found[1] == found[3] == cold(edit(text))


PIECES = (
    "",
    "",
    "{",
    "}",
    "<",
    ">",
    "|",
    "\n",
    " set",
    "Event (ns=t) end\n",
    "var <fetch.part>: { }\n",
    "<end>",
    "// ",
    "Scenario idle {",
    "bench-to-tray",
    " " * 8,
)


@pytest.mark.parametrize("text", [FAULTY, FAULTY_SCENARIOS], ids=["one scenario", "scenarios"])
@pytest.mark.parametrize("seed", range(4))
def test_random_edits_give_what_a_fresh_analysis_gives(seed: int, text: str) -> None:
    random = Random(seed)
    warm = project()
    for _ in range(40):
        start = random.randrange(len(text))
        edited = text[:start] + random.choice(PIECES) + text[start + random.choice((0, 0, 1, 5, 60)) :]
        states = [edited, text] if random.random() < 0.5 else [edited]
        for state in states:
            warm.open(URI, 1, state)
            found = fast_diagnostics(warm.snapshot(), URI)
            assert found == cold(state), state
        text = states[-1]


def test_an_edit_of_an_imported_scene_is_noticed() -> None:
    warm = project()
    warm.open(URI, 1, MODEL)
    assert fast_diagnostics(warm.snapshot(), URI) == []
    smaller = SCENE.replace(" ws comp <tray_comp> }", " }").replace(" ws comp <tray_comp> agn", " agn")
    warm.open(f"{FOLDER}lab.scene", 2, smaller)
    assert fast_diagnostics(warm.snapshot(), URI) == cold(MODEL, smaller) != []


def test_an_unchanged_declaration_is_not_looked_at_again(monkeypatch: pytest.MonkeyPatch) -> None:
    warm = project()
    text = FAULTY.replace(TEMPLATE, "Event (ns=t) apart\n" + TEMPLATE)
    warm.open(URI, 1, text)
    before = fast_diagnostics(warm.snapshot(), URI)
    warm.open(URI, 2, text.replace("apart\n", "apart // now\n"))
    monkeypatch.setattr(memo, "Site", None)
    after = fast_diagnostics(warm.snapshot(), URI)
    start, moved = text.index("apart") + len("apart"), len(" // now")
    assert [entry.code for entry in after] == [entry.code for entry in before]
    assert [entry.span for entry in after if entry.span.start > start] == [
        entry.span.shifted(moved) for entry in before if entry.span.start > start
    ]


def test_an_edit_in_a_scenario_looks_at_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    warm = project()
    warm.open(URI, 1, FAULTY_SCENARIOS)
    before = fast_diagnostics(warm.snapshot(), URI)
    assert {"type-conflict", "missing-value", "empty-duration"} <= {entry.code for entry in before}
    asked: list[str] = []

    class Watched(Site):
        def __init__(self, snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration) -> None:
            super().__init__(snapshot, file, placed)
            asked.append(placed.declaration.symbols[0].name)

    monkeypatch.setattr(memo, "Site", Watched)
    place = FAULTY_SCENARIOS.index("idle {") + len("idle {")
    edited = f"{FAULTY_SCENARIOS[:place]} // now{FAULTY_SCENARIOS[place:]}"
    warm.open(URI, 2, edited)
    after = fast_diagnostics(warm.snapshot(), URI)
    assert asked == ["idle"]
    assert after == cold(edited)
