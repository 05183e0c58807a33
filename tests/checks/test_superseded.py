"""A mistake is reported once: shapes do not repeat findings of rules, but report all others."""

import pytest

from checks.models import LINES, SETS, story
from kit import EVENTS, MODEL, STORY, TEMPLATE, corpus, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.names.project import Project

TABLE = "| <fetch.part> | <fetch.robot> | <fetch.goal> |\n|---|\n| <parts.bolt> | <arms.panda> |\n"
GOALS = "set var <fetch.goals>: select 3 combinations from <places>\n"
MISTAKES = {
    "missing-value": EVENTS + TEMPLATE + STORY.replace("var <fetch.robot>: { <arms.panda> }", ""),
    "repeated-value": story(LINES + "var <fetch.part>: { <parts.bolt> }\n"),
    "row-width": story(TABLE),
    "selection-size": story(LINES + GOALS, SETS),
    "empty-set": MODEL.replace("{ <arms.panda> }", "{ }"),
    "type-conflict": MODEL.replace("{ <arms.panda> }", "{ <arms.panda>, <parts.bolt> }"),
    "empty-duration": MODEL.replace("until <end>", "until <start>"),
    "quantity": MODEL.replace(
        "in-tray: holds(<part> is located at <goal>", "in-tray: holds(<part> is tilted less than 5 m"
    ),
    "duplicate-iri": MODEL + TEMPLATE.replace("fetch", "bring").replace("in-tray", "at-tray"),
    "foreign-variable": MODEL.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =")
    + TEMPLATE.replace("fetch", "bring").replace("(ns=t)", "(ns=o)")
    + STORY.replace("fetching", "more")
    .replace("bench-to-tray", "again")
    .replace("var <fetch.part>: obj", "var <fetch.part>: { <parts.nut> } var <bring.part>: obj"),
}


@pytest.mark.parametrize("code", sorted(MISTAKES))
def test_a_mistake_is_reported_once(code: str) -> None:
    case = fixture(MISTAKES[code])
    every = all_diagnostics(case.snapshot, case.uri)
    found = [entry for entry in every if entry.severity < Severity.INFORMATION and entry.code != "no-model"]
    assert [entry.code for entry in found] == [code], found


def test_a_contradiction_in_a_template_is_not_repeated_at_the_values_of_its_variants() -> None:
    variant = STORY[STORY.index("        Scenario ") : STORY.rindex("}")]
    more = "".join(variant.replace("bench-to-tray", name) for name in ("again", "third"))
    text = EVENTS + TEMPLATE.replace("located at <goal>, before", "held by <goal>, before") + STORY.rpartition("}")[0]
    sibling = TEMPLATE.replace("fetch", "bring").replace("on-bench", "at-bench").replace("in-tray", "at-tray")
    of_sibling = STORY.replace("fetch", "bring").replace("bench-to-tray", "other")
    for models in (text + more + "}\n", text + "}\n" + sibling.replace("carry", "bear") + of_sibling):
        case = fixture(models)
        found = [one for one in all_diagnostics(case.snapshot, case.uri) if one.severity < Severity.WARNING]
        assert {one.code for one in found} == {"type-conflict"}
        assert all(one.span.start < models.index("User Story") for one in found)
    # A value that contradicts sound clauses is still reported at each of its places.
    wrong = fixture((MODEL.rpartition("}")[0] + more + "}\n").replace("{ <arms.panda> }", "{ <parts.bolt> }"))
    found = [one for one in all_diagnostics(wrong.snapshot, wrong.uri) if one.severity < Severity.WARNING]
    assert [one.code for one in found] == ["type-conflict"] * 3


def test_what_only_a_shape_finds_is_still_told() -> None:
    case = fixture(MODEL.replace("0.5 seconds", "-1 seconds"))
    found = {entry.code for entry in all_diagnostics(case.snapshot, case.uri)}
    assert found - {"no-model", "catalog-models"} == {"shacl-horizon"}


def test_foreign_models_raise_no_false_alarm() -> None:
    project = Project()
    uris = [path_to_uri(path) for path in corpus(".bdd", ".scene")]
    for uri in uris:
        project.load(uri)
    snapshot = project.snapshot()
    alarms = [entry for uri in uris for entry in all_diagnostics(snapshot, uri) if entry.severity <= Severity.WARNING]
    # Clauses that stay unknown here get a warning: configurations of another simulator, text that nothing judges, and
    # the one workspace that no object carries.
    assert [entry for entry in alarms if entry.code not in ("setting", "no-evaluator", "no-region")] == []
    (bare,) = (entry for entry in alarms if entry.code == "no-region")
    assert "carries 'lab_workspaces.shelf_ws'" in bare.message
    assert all(entry.severity is Severity.WARNING for entry in alarms)
