"""A hundred structural defects planted one at a time, in a model and its imports: each is found on its token."""

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
"""File, original text, replacement, and the text that the finding must be on."""
SCENE_DEFECTS = (
    ("{ object bolt, object nut }", "{ }", "parts", ()),
    ("{ obj <furniture.tray> }", "{ }", "tray_comp", ()),
    ("object nut", "object bolt", "bolt", ("bolt",)),
    ("of ws <places.bench_ws>", "of ws <parts.nut>", "parts.nut", ("nut",)),
    ("obj <furniture.tray>", "obj <arms.panda>", "arms.panda", ("panda",)),
    ("ws comp <tray_comp> }\n", "ws <parts.nut> }\n", "parts.nut", ("nut",)),
    ("{ obj set <parts>", "{ obj set <places>", "places", ("places",)),
    ("agn set <arms> }", "agn set <parts> }", "parts", ("parts",)),
    ("{ obj <furniture.tray> }", "{ obj <furniture.tray> ws <places.tray_ws> }", "places.tray_ws", ("tray_ws",)),
    ("obj <furniture.bench>", "obj <bench>", "bench", ()),
)
"""Text of the imported scene, its replacement, the text of the finding, and its related texts."""
HARMLESS = ("unused", "no-scenario", "catalog-models", "no-model")
"""Codes that the sound model has as well."""


def block(text: str, number: int) -> str:
    names = r"\b(fetch|fetching|on-bench|in-tray|bench-to-tray|carry)\b"
    return re.sub(names, rf"\g<1>{number}", text)


def planted(defect: int, number: int) -> dict[str, str]:
    """Return the files with a defect in one block, which gets its own name like all blocks."""
    file, old, new, _ = DEFECTS[defect]
    texts = {BASE: EVENTS, MAIN: 'import "base.bdd"\n' + EVENTS.partition("Task")[0]}
    for place in range(BLOCKS):
        for uri, sound in ((BASE, TEMPLATE), (MAIN, STORY)):
            hit = place == number and uri == file
            assert not hit or old in sound
            texts[uri] += block(sound.replace(old, new, 1) if hit else sound, place)
    return {**texts, f"{FOLDER}lab.scene": SCENE}


def findings(texts: dict[str, str], asked: str = MAIN) -> list[Diagnostic]:
    project = Project()
    for uri, text in texts.items():
        project.open(uri, 1, text)
    return [one for one in all_diagnostics(project.snapshot(), asked) if not one.code.startswith(HARMLESS)]


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


def test_defects_of_an_imported_scene_are_told_once_in_its_file_with_the_other_end_of_the_relation() -> None:
    sound = {f"{FOLDER}lab.scene": SCENE, MAIN: EVENTS + TEMPLATE + STORY}
    missed: list[tuple[str, list[Diagnostic]]] = []
    for old, new, token, ends in SCENE_DEFECTS:
        assert old in SCENE
        texts = {**sound, f"{FOLDER}lab.scene": SCENE.replace(old, new, 1)}
        found = [one for one in findings(texts) if one.uri != MAIN]
        told = [
            (
                texts[one.uri][one.span.start : one.span.end],
                tuple(texts[place.uri][place.span.start : place.span.end] for place in one.related),
            )
            for one in found
        ]
        if told != [(token, ends)]:
            missed.append((new, found))
    assert not missed


def test_a_similar_set_of_no_members_is_told_once() -> None:
    uri, text = f"{FOLDER}lab.scene", SCENE.replace("count: 3", "count: 0")
    found = findings({uri: text}, uri)
    assert [(one.code, text[one.span.start : one.span.end]) for one in found] == [("shacl-similar-count", "0")]
