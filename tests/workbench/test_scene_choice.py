"""Scenarios of a ``.bdd`` run in the scene instance of a ``.scenex`` that the user names, and results state it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main
from robbdd_tools.features.run_verdicts import Digests
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.lsp.client_settings import Settings
from robbdd_tools.lsp.run_options import BadSetting, RunOptions, select
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.run.used_files import digests
from robbdd_tools.run.user_code import refusal
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.judged_scenarios import judged_scenario
from robbdd_tools.workbench.model import ModelErrors
from robbdd_tools.workbench.named_files import NotAModel
from robbdd_tools.workbench.plan import Plan
from robbdd_tools.workbench.rerun import failed_in
from robbdd_tools.workbench.scene_choice import SceneChoiceError
from world.hollow import HULL, write_tote

WORDS = "executed in the scene instance 'cell_sim' of cell.scenex"
INSTANCE = "https://example.org/robbdd/ownrobot/simulation/cell_sim"


@pytest.fixture
def tidy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An example whose arm is known to its ``.scenex`` only."""
    folder = shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "cell")
    monkeypatch.chdir(folder)
    return Path("tidy.bdd")


def edit(path: str, old: str, new: str) -> None:
    text = Path(path).read_text(encoding="utf-8")
    assert old in text
    Path(path).write_text(text.replace(old, new), encoding="utf-8")


def refused(model: Path | str, scenex: str, error: type[Exception] = SceneChoiceError) -> str:
    with pytest.raises(error) as caught:
        robbdd.load(model).scenarios(scenex=scenex)
    return str(caught.value)


def test_a_scenario_gets_what_an_execution_gets(tidy: Path, tmp_path: Path) -> None:
    plan = robbdd.load(tidy).scenarios(scenex="cell.scenex")
    executed = robbdd.load("tidy.bddx").scenarios("by-catalog")
    assert [spec.instance for spec in plan.scenarios] == [spec.instance for spec in executed.scenarios]
    assert {spec.choices for spec in plan.scenarios} == {(WORDS,)}
    assert {spec.choices for spec in executed.scenarios} == {()}
    manifest = plan.prepare(tmp_path / "run")
    assert read_manifest(tmp_path / "run") == manifest
    assert (tmp_path / "run" / "manifest.json").read_text(encoding="utf-8").count('"links"') == 1


def test_a_file_that_does_not_fit_is_refused_with_the_instances_there_are(tidy: Path) -> None:
    other = str(EXAMPLES / "pickplace" / "bench.scenex")
    said = refused(tidy, other)
    assert said.startswith("cube-to-bin runs in the scene env:cell, which is not instantiated: there is bench_sim (")
    assert said.endswith("bench.scenex:6:21) of the scene bench_scene")
    assert refused("tidy.bddx", "cell.scenex").startswith("every selected scenario runs in the scene instance of its")
    assert refused(tidy, "tidy.bdd", NotAModel) == "tidy.bdd is not a .scenex file"
    assert "there is no file 'none.scenex'" in refused(tidy, "none.scenex", ModelErrors)
    Path("empty.scenex").write_text('import "cell.scenex"\n', encoding="utf-8")
    assert refused(tidy, "empty.scenex") == "empty.scenex declares no scene inst"


def test_two_instances_that_fit_are_named(tidy: Path) -> None:
    with Path("cell.scenex").open("a", encoding="utf-8") as file:
        file.write("\nscene inst (ns=sim) again { scene: <cell> }\n")
    said = refused(tidy, "cell.scenex")
    assert said.startswith("several scene instances fit cube-to-bin: again (")
    assert "cell_sim (" in said


def test_python_code_that_creates_a_model_is_refused_without_trust(
    tidy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit("cell.scenex", "sys path = 'five.xml'", "py { module: carrying, attr: model }")
    manifest = robbdd.load(tidy).scenarios(scenex="cell.scenex").prepare(tmp_path / "run")
    monkeypatch.setenv("ROBBDD_NO_USER_CODE", "1")
    assert "cell.scenex:67:15: a model is created by the Python code carrying:model" in refusal(manifest, tmp_path)


def test_an_editor_names_the_file_from_the_folder_of_the_model(tidy: Path) -> None:
    (file,) = robbdd.load(tidy).files
    selection, _ = select(RunOptions.of({"uri": file.uri, "scenex": "cell.scenex"}), file.acceptance, ())
    plan = Plan.of_files(file.uri, None, (file,), selection)
    (spec, *_) = plan.scenarios
    assert spec.choices == (WORDS,)
    result = judged_scenario(spec, file.uri, Digests({}, {}, {}, {}), "", run=1, index=0, seed=None)
    again, _ = select(RunOptions.of({"uri": file.uri, "failed": True}), file.acceptance, [result])
    assert [spec.choices for spec in Plan.of_files(file.uri, None, (file,), again).scenarios] == [(WORDS,)]


def by_setting(model: Path, section: object, folder: Path, **options: object) -> list[tuple[str, ...]]:
    """Return the remarks on the scene of each scenario that a run from an editor with this setting plans."""
    (file,) = robbdd.load(model).files
    settings = Settings()
    assert settings.set(path_to_uri(folder), {"run": {"scenex": section}}) is None
    defaults = settings.run_defaults(file.uri)
    selection, _ = select(RunOptions.of({"uri": file.uri, **options}), file.acceptance, (), defaults)
    return [spec.choices for spec in Plan.of_files(file.uri, None, (file,), selection).scenarios]


def test_a_setting_of_the_editor_names_files_from_its_workspace_folder(tidy: Path, tmp_path: Path) -> None:
    remarks = by_setting(tidy, ["cell/cell.scenex"], tmp_path)
    assert remarks
    assert set(remarks) == {(WORDS,)}
    edit("tidy.bdd", "    Scenarios:\n", f"    Scenarios:\n{OTHER}")
    edit("cell.scene", "scene (ns=env) cell {", f"{OTHER_SCENE}scene (ns=env) cell {{")
    assert set(by_setting(tidy, ["cell/cell.scenex"], tmp_path)) == {(WORDS,), ()}
    assert set(by_setting(Path("tidy.bddx"), ["cell/cell.scenex"], tmp_path)) == {()}
    assert set(by_setting(tidy, ["cell/none.scenex"], tmp_path, scenario="cube-to-bin", scenex="cell.scenex")) == {
        (WORDS,)
    }


@pytest.mark.parametrize(
    ("section", "told"),
    [
        (["cell/none.scenex"], "there is no file '"),
        (["cell/empty.scenex"], "empty.scenex declares no scene inst"),
    ],
)
def test_a_setting_that_cannot_be_used_is_named(tidy: Path, tmp_path: Path, section: object, told: str) -> None:
    Path("empty.scenex").write_text('import "cell.scenex"\n', encoding="utf-8")
    with pytest.raises(BadSetting, match=r"^the setting 'robbdd\.run\.scenex' cannot be used: ") as caught:
        by_setting(tidy, section, tmp_path)
    assert told in str(caught.value)


@pytest.mark.parametrize("section", ["cell.scenex", ["cell.scene"], [7], {"cell": "cell.scenex"}])
def test_a_setting_of_another_form_is_reported_and_keeps_the_others(section: object) -> None:
    settings, cell = Settings(), Path("/cell/cell.scenex")
    assert settings.set("file:///cell", {"run": {"scenex": ["cell.scenex"]}}) is None
    stated = {"shapes": ["a.ttl"], "run": {"scenex": section}}
    assert "robbdd.run.scenex" in str(settings.set("file:///cell", stated))
    assert settings.run_defaults("file:///cell/a.bdd").scenex == (cell,)
    assert settings.shapes("file:///cell/a.bdd").patterns == ("a.ttl",)


def test_an_unselected_scenario_of_another_scene_needs_no_instance(tidy: Path) -> None:
    edit("tidy.bdd", "    Scenarios:\n", f"    Scenarios:\n{OTHER}")
    edit("cell.scene", "scene (ns=env) cell {", f"{OTHER_SCENE}scene (ns=env) cell {{")
    assert "elsewhere runs in the scene env:other_cell" in refused(tidy, "cell.scenex")
    plan = robbdd.load(tidy).scenarios("cube-to-bin", scenex="cell.scenex")
    assert {spec.choices for spec in plan.scenarios} == {(WORDS,)}
    with pytest.raises(SelectionError):
        robbdd.load(tidy).scenarios("nowhere", scenex="cell.scenex")


OTHER_SCENE = "scene (ns=env) other_cell { obj set <cubes> ws comp <bench> ws comp <in_bin> agn set <arms> }\n"
OTHER = """        Scenario elsewhere {
            template: <tidy>
            scene: <other_cell>

            variation:
                var <tidy.thing>: obj set <cubes>
                var <tidy.robot>: agn set <arms>
                var <tidy.source>: { <places.table_ws> }
                var <tidy.goal>: { <places.bin_ws> }
        }

"""


@pytest.mark.physics
def test_results_state_the_instance_and_later_commands_keep_it(tidy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(tidy), "--first", "1", "--no-store"]) == 1
    assert "or give it a model in a .scenex that --scenex or an execution of a .bddx names" in capsys.readouterr().out
    edit("tidy.bdd", "held by <robot>, after <evt-pick-end>", "held by <robot>, after <evt-place-end>")
    run = ["run", str(tidy), "--scenex", "cell.scenex", "--first", "1"]
    assert main([*run, "--json", "run.json", "--junit", "run.xml"]) == 1
    assert WORDS in capsys.readouterr().out
    assert WORDS in Path("run.xml").read_text(encoding="utf-8")
    (scenario,) = json.loads(Path("run.json").read_text(encoding="utf-8"))["scenarios"]
    scenex = str(Path("cell.scenex").absolute())
    assert scenario["scene_instance"] == {"instance": INSTANCE, "file": scenex}
    assert {clause["verdict"] for clause in scenario["clauses"]} == {"holds", "violated"}
    (past,) = robbdd.runs(tidy)
    (result,) = past.results
    assert next(result.rows())["scene_instance"] == str(result.scene_instance) == WORDS
    assert failed_in(past.place).scenex == (Path(scenex),)
    for command in (["run", str(tidy), "--rerun-failed"], ["judge", "1", str(tidy)]):
        assert main(command) == 1
        assert WORDS in capsys.readouterr().out
    assert main(["replay", "1"]) == 0
    edit("cell.scenex", "(50, 0, 10) cm", "(51, 0, 10) cm")
    capsys.readouterr()
    assert main(["replay", "1"]) == 2
    assert "cell.scenex was changed since the run" in capsys.readouterr().err


def add_room(text: str) -> None:
    """Give the cell a model of the whole scene with this MJCF text."""
    Path("room.xml").write_text(text, encoding="utf-8")
    edit(
        "cell.scenex",
        "    scene: <cell>\n",
        "    scene: <cell>\n    model room_model as mjcf { sys path = 'room.xml' }\n",
    )


@pytest.mark.physics
def test_a_run_names_the_bodies_of_the_scene_through_which_everything_passes(
    tidy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    curtain = '<body name="curtain" pos="0 0 2"><geom size=".1" contype="0" conaffinity="0"/></body>'
    add_room(f"<mujoco><worldbody>{curtain}</worldbody></mujoco>")
    assert main(["run", str(tidy), "--scenex", "cell.scenex", "--repeat", "2", "--no-store"]) == 0
    said = capsys.readouterr()
    notes = [line for line in (said.out + said.err).splitlines() if "passes through" in line]
    assert notes == [
        "warning: no collision shapes in the model of the whole scene, so everything passes through: curtain"
    ]


@pytest.mark.physics
def test_a_run_names_objects_with_a_hollow_mesh(tidy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_tote(Path("tote.obj"))
    mesh = '<asset><mesh name="shell" file="tote.obj" scale="0.1 0.15 0.3"/></asset>'
    body = '<body name="cube"><freejoint/><geom type="mesh" mesh="shell" mass="0.1"/></body>'
    Path("tote.xml").write_text(f"<mujoco>{mesh}<worldbody>{body}</worldbody></mujoco>", encoding="utf-8")
    edit("cell.scenex", 'catalog "cube"', "sys path = 'tote.xml'")
    main(["run", str(tidy), "--scenex", "cell.scenex", "--no-store"])
    said = capsys.readouterr()
    (line,) = [line for line in (said.out + said.err).splitlines() if "hollow" in line]
    assert "'robbdd cut MODEL' cuts it into convex pieces: " in line


@pytest.mark.physics
def test_a_run_names_hollow_meshes(tidy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_tote(Path("tote.obj"))
    mesh = '<asset><mesh name="cabinet" file="tote.obj"/></asset>'
    shape = '<worldbody><geom type="mesh" mesh="cabinet" pos="0 0 3"/></worldbody>'
    add_room(f"<mujoco>{mesh}{shape}</mujoco>")
    assert main(["run", str(tidy), "--scenex", "cell.scenex", "--no-store"]) == 0
    said = capsys.readouterr()
    assert [line for line in (said.out + said.err).splitlines() if "hollow" in line] == [
        f"warning: a hollow mesh, which collides as its convex hull with {HULL:.1f} times its volume; "
        "'robbdd cut MODEL' cuts it into convex pieces: cabinet"
    ]


BOTH = ("env:blue_ws", "env:red_ws")
GRAPH = """@prefix env: <https://example.org/robbdd/rightbin/environment/> .
@prefix rbw: <https://robbdd.org/metamodels/workbench#> .
env:red_ws rbw:correct-for env:cube_2 .
"""
CHOSEN = """import "station.scene"
import "known{ending}"
ns sim = 'https://example.org/sim/'
scene inst (ns=sim) chosen {{ scene: <station> }}
"""


@pytest.mark.physics
@pytest.mark.parametrize("ending", [".ttl", ".jsonld"])
def test_the_graphs_that_a_named_scenex_imports_count_in_the_run(ending: str, tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "rightbin", tmp_path / "bin")
    text = GRAPH if ending == ".ttl" else serialize(parse(GRAPH, "ttl"), "json-ld")
    (folder / f"known{ending}").write_text(text, encoding="utf-8")
    (folder / "chosen.scenex").write_text(CHOSEN.format(ending=ending), encoding="utf-8")
    model = robbdd.load(folder / "rightbin.bdd")
    plain, chosen = model.scenarios("wrong-order"), model.scenarios("wrong-order", scenex=folder / "chosen.scenex")
    for plan, places, verdict in ((plain, ("env:blue_ws",), "violated"), (chosen, BOTH, "holds")):
        (spec,) = plan.scenarios
        assert spec.scene.correct_places["env:cube_2"] == places
        with plan.run(seed=1, keeping=Keeping(tmp_path / "runs" / verdict)) as run:
            (result,) = run.results
        assert {clause.name: clause.verdict for clause in result.clauses}["right-bin"] == verdict
    stored = next((tmp_path / "runs" / "holds").rglob("manifest.json")).parent
    assert read_manifest(stored).scenarios == tuple(chosen.scenarios)
    used = {Path(name).name for name in digests(read_manifest(stored), stored)}
    assert used == {"chosen.scenex", f"known{ending}"}


def test_a_fault_in_such_a_graph_is_an_error_of_the_scenex(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "rightbin", tmp_path / "bin")
    (folder / "known.ttl").write_text(GRAPH + "env:red_ws env: ; .", encoding="utf-8")
    (folder / "chosen.scenex").write_text(CHOSEN.format(ending=".ttl"), encoding="utf-8")
    assert "known.ttl:4:" in refused(folder / "rightbin.bdd", str(folder / "chosen.scenex"), ModelErrors)
