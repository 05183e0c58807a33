"""Code lenses that were kept equal those of a fresh analysis, whatever was edited."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types
from lsprotocol.converters import get_converter
from tests.bench.models import long_story

from edits import PIECES, Edit
from kit import FOLDER, MODEL, SCENE, STORY
from robbdd_tools.checks.file_caches import without_cache
from robbdd_tools.features.pass_rates import pass_rate
from robbdd_tools.features.run_verdicts import NOTHING, Findings, JudgedScenario, Judgement, variant_digest
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.lenses import LensWriter
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.names.variant_places import VariantIris, variants_of

URI = f"{FOLDER}main.bdd"
_PROTOCOL = get_converter()
TEXTS = (MODEL, long_story(60), MODEL + STORY.replace("fetching", "again"), MODEL.replace("(ns=t) ", ""))
EDITS = st.builds(
    Edit,
    st.just(0),
    st.sampled_from(["replace", "delete", "duplicate", "half", "undo"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 1, 5, 20, 100, 400]),
    st.sampled_from(
        [*PIECES, "\n\n", " 😀 ", "Scenario bench-to-tray1-1 {", "ns u = 'urn:u:'\n", "<parts>", "obj set <parts>"]
    ),
)


def serialise(value: object) -> str:
    return json.dumps(_PROTOCOL.unstructure(value))


def opened() -> Project:
    made = Project()
    made.open(f"{FOLDER}lab.scene", 1, SCENE)
    return made


def results(snapshot: Snapshot) -> Findings:
    """A passed execution of each variant."""
    judged: dict[str, tuple[JudgedScenario, ...]] = {}
    for variant in variants_of(snapshot, URI):
        digest = variant_digest(snapshot, variant)
        clauses = {"c": Judgement("c", "holds", "", 0.0, "holds", "")}
        judged[variant.iri] = (JudgedScenario(URI, variant.iri, 1, "", digest, "", clauses, finished=True),)
    return Findings({}, judged)


def expected(snapshot: Snapshot, findings: Findings) -> list[tuple[str, int, Any, str]]:
    """The number of scenarios and the pass rate at each variant, found without any cache."""
    found: list[tuple[str, int, Any, str]] = []
    for one in variants_of(snapshot, URI):
        rate = pass_rate(snapshot, one, findings, number_of_scenarios(one))
        line = snapshot.document(URI).position(one.definition.span.start).line
        found.append((one.iri, line, number_of_scenarios(one), "" if rate is None else rate.label))
    return found


def shown(text: str) -> list[tuple[str, int, Any, str]]:
    """The same, read from lenses."""
    found: list[tuple[str, int, Any, str]] = []
    for lens in json.loads(text):
        command, line = lens["command"], lens["range"]["start"]["line"]
        if command["title"] == "Debug":
            target = command["arguments"][0]
            found.append((target["variant"], line, target["count"], ""))
        elif " passed" in command["title"]:
            found[-1] = (*found[-1][:3], command["title"])
    return found


@given(st.sampled_from(TEXTS), st.lists(EDITS, max_size=8), st.booleans())
def test_lenses_over_any_edits_are_those_of_a_fresh_analysis(text: str, edits: Sequence[Edit], ran: bool) -> None:
    project, convert, writer, history = opened(), Converter(), LensWriter(serialise, debugs=True, counts=True), [text]
    project.open(URI, 0, text)
    findings = results(project.snapshot()) if ran else NOTHING
    for version, edit in enumerate([Edit(0, "replace", 0, 0, ""), *edits]):
        project.open(URI, version, edit.apply(history))
        snapshot, fresh = project.snapshot(), opened()
        fresh.open(URI, version, history[-1])
        kept = writer.text(convert, snapshot, URI, findings).text
        with without_cache():
            other = LensWriter(serialise, debugs=True, counts=True).text(convert, fresh.snapshot(), URI, findings).text
        assert json.loads(kept) == json.loads(other)
        assert shown(kept) == expected(fresh.snapshot(), findings)
        analysis = snapshot.file(URI)
        assert analysis is not None
        iris = [iri for part in analysis.parts() for iri in VariantIris(snapshot, analysis).of(part)]
        assert [iri for iri in iris if iri is not None] == [one.iri for one in variants_of(snapshot, URI)]


def test_a_changed_scene_changes_the_numbers() -> None:
    project, convert, writer = opened(), Converter(), LensWriter(serialise, debugs=True, counts=True)
    project.open(URI, 1, MODEL)
    before = shown(writer.text(convert, project.snapshot(), URI, NOTHING).text)
    project.open(f"{FOLDER}lab.scene", 2, SCENE.replace("object nut", "object nut, object pin"))
    after = shown(writer.text(convert, project.snapshot(), URI, NOTHING).text)
    assert [count for _, _, count, _ in before] == [4]
    assert [count for _, _, count, _ in after] == [6]


def test_an_edit_in_a_scenario_writes_no_other_lens() -> None:
    written: list[str] = []

    def count(value: object) -> str:
        assert isinstance(value, types.CodeLens)
        written.append(value.command.title if value.command is not None else "")
        return serialise(value)

    project, convert, writer = opened(), Converter(), LensWriter(count, debugs=False, counts=False)
    text = long_story(100)
    for version, now in enumerate([text, f"\n{text}", text.replace("variation:", "variation: ", 1)]):
        written.clear()
        project.open(URI, version, now)
        writer.text(convert, project.snapshot(), URI, NOTHING)
        assert written.count("Run") == (text.count("template:"), 0, 1)[version]


@pytest.mark.parametrize(("counts", "expected"), [(True, ["4 scenarios"]), (False, [])])
def test_the_number_of_scenarios_is_shown_once(counts: bool, expected: list[str]) -> None:
    project, writer = opened(), LensWriter(serialise, debugs=True, counts=counts)
    project.open(URI, 1, MODEL)
    text = writer.text(Converter(), project.snapshot(), URI, NOTHING).text
    assert [title for lens in json.loads(text) if "scenario" in (title := lens["command"]["title"])] == expected
