"""Scenarios listed before a run equal those of the run."""

from __future__ import annotations

from pathlib import Path

from kit import MODEL, fixture
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Iri
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.run.listing import ListedScenario, listed_scenarios
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.report import plain_sentence

VARIANT = Iri("https://example.org/t/bench-to-tray")
ASSIGNED = MODEL[MODEL.index("                var <fetch.part>: obj set") : MODEL.rindex("        }\n}\n")]
TABLE = """                | <fetch.part> | <fetch.robot> | <fetch.goal> |
                |---|---|---|
                | <parts.bolt> | <arms.panda> | <places.tray_ws> |
                | <parts.bolt> | <arms.ur10> | <places.tray_ws> |
"""


def model_of(text: str) -> AcceptanceModel:
    made = fixture(text)
    return read_model(build_graph(made.snapshot, made.uri).graph)


def listed(text: str, first: int = 1, most: int = 100) -> list[ListedScenario]:
    return list(listed_scenarios(model_of(text), VARIANT, first, most))


def test_what_varies_is_told_apart_from_what_all_scenarios_share() -> None:
    assert [(one.number, one.varying, one.shared) for one in listed(MODEL)] == [
        (1, "part = bolt, goal = bench_ws", "robot = panda"),
        (2, "part = bolt, goal = tray_ws", "robot = panda"),
        (3, "part = nut, goal = bench_ws", "robot = panda"),
        (4, "part = nut, goal = tray_ws", "robot = panda"),
    ]


def test_rows_of_a_table_are_told_by_the_columns_that_differ() -> None:
    assert [(one.varying, one.shared) for one in listed(MODEL.replace(ASSIGNED, TABLE))] == [
        ("robot = panda", "part = bolt, goal = tray_ws"),
        ("robot = ur10", "part = bolt, goal = tray_ws"),
    ]


def test_a_part_of_the_scenarios_can_be_listed() -> None:
    assert [one.number for one in listed(MODEL, 2, 2)] == [2, 3]
    assert [one.number for one in listed(MODEL, 4, 9)] == [4]
    assert listed(MODEL, 5) == []


def test_the_clauses_are_those_of_the_run_in_its_order(tmp_path: Path) -> None:
    manifest = prepare(RunRequest(model_of(MODEL), "main.bdd"), tmp_path)
    for scenario, spec in zip(listed(MODEL), manifest.scenarios, strict=True):
        assert [(one.iri, one.name, one.role, one.sentence) for one in scenario.clauses] == [
            (clause.iri, clause.name, clause.role, plain_sentence(clause.sentence)) for clause in spec.clauses
        ]
