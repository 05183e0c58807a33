"""A run folder contains all data for the agent: seeds, places, events, lines of clauses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from kit import MODEL, SCENE, fixture
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Execution, Iri
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import ExecutionSpec, Manifest
from robbdd_tools.run.prepare import RunRequest, prepare


def model(text: str = MODEL) -> AcceptanceModel:
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{SCENE}")
    return read_model(build_graph(case.snapshot, case.uri).graph)


def manifest(folder: Path, text: str = MODEL, seed: int = 1) -> Manifest:
    return prepare(RunRequest(model(text), "main.bdd", seed), folder)


def test_the_folder_holds_features_hooks_steps_and_manifest(tmp_path: Path) -> None:
    written = manifest(tmp_path)
    assert read_manifest(tmp_path) == written
    names = sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file())
    assert names == [
        "features/environment.py",
        "features/fetching.feature",
        "features/fetching.feature.map.json",
        "features/steps/catalog_steps.py",
        "manifest.json",
    ]


def test_clauses_are_found_at_their_feature_lines(tmp_path: Path) -> None:
    scenario = manifest(tmp_path).scenarios[3]
    lines = (tmp_path / scenario.feature).read_text(encoding="utf-8").split("\n")
    assert lines[scenario.line - 1].endswith(scenario.name)
    for clause in scenario.clauses:
        assert lines[clause.line - 1].strip() == f"{clause.role.capitalize()} {clause.sentence}"


def test_things_start_where_the_given_clauses_want_them(tmp_path: Path) -> None:
    places = [scenario.scene.places for scenario in manifest(tmp_path).scenarios]
    assert places[:2] == [{"env:bolt": "env:bench_ws"}, {"env:bolt": "env:tray_ws"}]


def test_events_are_bound_to_what_emits_them(tmp_path: Path) -> None:
    text = MODEL.replace("Event (ns=t) end", "Event (ns=t) end\nEvent (ns=t) evt_pick_end\nEvent (ns=t) bell")
    text = text.replace("0.5 seconds after <place-end>", "from <evt_pick_end> until <bell>")
    assert manifest(tmp_path, text).scenarios[0].events == {
        "t:start": "scenario-start",
        "t:end": "scenario-end",
        "t:pick-start": "pick-start",
        "t:place-end": "place-end",
        "t:evt_pick_end": "pick-end",
    }


def test_each_scenario_has_its_own_seed_whatever_else_runs(tmp_path: Path) -> None:
    seeds = [scenario.seed for scenario in manifest(tmp_path / "a").scenarios]
    assert len(set(seeds)) == 4
    assert [scenario.seed for scenario in manifest(tmp_path / "b", seed=2).scenarios] != seeds
    renamed = MODEL.replace("obj set <parts>", "{ <parts.bolt> }")
    assert [scenario.seed for scenario in manifest(tmp_path / "c", renamed).scenarios] == seeds[:2]


def test_only_the_wanted_variants_are_written(tmp_path: Path) -> None:
    variants = {Iri("https://example.org/t/elsewhere")}
    assert prepare(RunRequest(model(), "main.bdd", variants=variants), tmp_path).scenarios == ()


def test_the_same_model_and_seed_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        manifest(tmp_path / name)
    for path in (tmp_path / "a").rglob("*.*"):
        if path.is_file():
            assert path.read_bytes() == (tmp_path / "b" / path.relative_to(tmp_path / "a")).read_bytes()


def test_each_execution_has_its_scenarios_its_seed_and_its_features(tmp_path: Path) -> None:
    plain = model()
    variant = plain.stories[0].variants[0].iri
    own, other = Implementation("x:own", "catalog", "pick-place"), Implementation("x:other", "python", "a.b:C")
    executions = (
        Execution(Iri("https://example.org/t/once"), variant, own, seed=7),
        Execution(Iri("https://example.org/t/again"), variant, other, repeat=3, timeout=20.0),
    )
    written = prepare(RunRequest(replace(plain, executions=executions), "main.bdd", 1), tmp_path)
    assert read_manifest(tmp_path) == written
    first, second = (
        [entry for entry in written.scenarios if entry.execution is not None and entry.execution.name == name]
        for name in ("t:once", "t:again")
    )
    assert [entry.name for entry in second] == [
        f"{entry.name} (repetition {number})" for entry in first for number in (1, 2, 3)
    ]
    assert len(first) * 4 == len(written.scenarios)
    assert {Path(entry.feature).parent.name for entry in first} == {"once"}
    alone = prepare(RunRequest(plain, "main.bdd", 7), tmp_path / "alone")
    assert [entry.seed for entry in first] == [entry.seed for entry in alone.scenarios]
    assert {entry.seed for entry in first}.isdisjoint({entry.seed for entry in second})
    assert second[0].execution == ExecutionSpec(executions[1].iri, "t:again", other, None, (), 3, 20.0)


def test_only_chosen_executions_are_run(tmp_path: Path) -> None:
    plain = model()
    variant, own = plain.stories[0].variants[0].iri, Implementation("x:own", "catalog", "pick-place")
    one, two = (Execution(Iri(f"https://example.org/t/{name}"), variant, own) for name in ("one", "two"))
    request = RunRequest(replace(plain, executions=(one, two)), "main.bdd", executions=(two,))
    names = {entry.execution.name for entry in prepare(request, tmp_path).scenarios if entry.execution is not None}
    assert names == {"t:two"}
