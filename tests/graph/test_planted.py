"""A hundred structural defects planted one at a time, in a model and in what it imports: each is found on its token."""

from __future__ import annotations

import re

from kit import EVENTS, FOLDER, SCENE, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.names.project import Project

MAIN, BASE = f"{FOLDER}main.bdd", f"{FOLDER}base.bdd"
BLOCKS = 10
GOAL = "var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }"
DEFECTS = (
    (BASE, "0.5 seconds", "0 seconds", "0"),
    (BASE, "    duration: from <start> until <end>\n", "", "fetch"),
    (BASE, "from <start> until <end>", "from <start> until <start>", "from <start> until <start>"),
    (BASE, "    task: <task>\n", "", "fetch"),
    (BASE, "<part> is located at <goal>, before", "pred('', p=<part>), before", "''"),
    (MAIN, "var <fetch.robot>: { <arms.panda> }", "", "bench-to-tray"),
    (MAIN, "obj set <parts>", "ws set <places>", "places"),
    (MAIN, "{ <arms.panda> }", "{ }", "{ }"),
    (MAIN, "{ <arms.panda> }", "{ <arms.panda>, <parts.nut> }", "parts.nut"),
    (MAIN, GOAL, "var <fetch.goal>: { <places.bench_ws>, 3 }", "3"),
)
"""File, what is written there, what stands there instead, and the text that the finding must be on."""
HARMLESS = ("unused", "no-scenario")
"""Codes that the sound model has as well."""


def block(text: str, number: int) -> str:
    names = r"\b(fetch|fetching|on-bench|in-tray|bench-to-tray|carry)\b"
    return re.sub(names, rf"\g<1>{number}", text)


def planted(defect: int, number: int) -> dict[str, str]:
    """Return the files with a defect in one block, which is given a name of its own as all blocks are."""
    file, old, new, _ = DEFECTS[defect]
    texts = {BASE: EVENTS, MAIN: 'import "base.bdd"\n' + EVENTS.partition("Task")[0]}
    for place in range(BLOCKS):
        for uri, sound in ((BASE, TEMPLATE), (MAIN, STORY)):
            hit = place == number and uri == file
            assert not hit or old in sound
            texts[uri] += block(sound.replace(old, new, 1) if hit else sound, place)
    return {**texts, f"{FOLDER}lab.scene": SCENE}


def findings(texts: dict[str, str]) -> list[Diagnostic]:
    project = Project()
    for uri, text in texts.items():
        project.open(uri, 1, text)
    return [one for one in all_diagnostics(project.snapshot(), MAIN) if not one.code.startswith(HARMLESS)]


def test_nearly_all_planted_defects_are_told_once_on_the_token_that_causes_them() -> None:
    missed: list[tuple[str, int, list[Diagnostic]]] = []
    for defect, (file, _, new, token) in enumerate(DEFECTS):
        for number in range(BLOCKS):
            texts = planted(defect, number)
            found = findings(texts)
            places = [(one.uri, texts[one.uri][one.span.start : one.span.end]) for one in found]
            if places != [(file, block(token, number))]:
                missed.append((new, number, found))
    assert len(missed) <= 0.05 * len(DEFECTS) * BLOCKS, missed


def test_what_a_wrong_value_contradicts_is_a_related_place() -> None:
    values = [number for number, defect in enumerate(DEFECTS) if defect[3] in ("places", "parts.nut", "3")]
    for defect in values:
        (found,) = findings(planted(defect, 3))
        assert {place.uri for place in found.related} == {BASE}
