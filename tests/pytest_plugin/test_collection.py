"""Pytest collects the scenarios of models as tests, when it is asked to."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

from kit import EXAMPLES, MODEL, SCENE
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.pytest_plugin.node_names import LONGEST, scenario_names
from robbdd_tools.workbench.model import load

pytest_plugins = ["pytester"]
FETCH = "bench.bdd::fetching::bench-to-tray"
ALL = [
    f"{FETCH}[{part}-panda-{goal}]" for part in ("bolt", "nut") for goal in ("bench_ws", "tray_ws")
]  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def loaded() -> None:
    """Load all that a session loads: pytester unloads it, and importlib_metadata and numpy cannot be unloaded."""
    import_module("numpy")
    import_module("robbdd_tools.pytest_plugin.session_hooks")
    load(EXAMPLES / "pickplace" / "pickplace.bdd").scenarios()


@pytest.fixture
def bench(pytester: pytest.Pytester) -> Path:
    """A project with one model of four scenarios."""
    (pytester.path / "lab.scene").write_text(SCENE, encoding="utf-8")
    path = pytester.path / "bench.bdd"
    path.write_text(MODEL, encoding="utf-8")
    return path


def session(pytester: pytest.Pytester, *arguments: str) -> pytest.RunResult:
    """Run pytest, without a plugin that warns if it is not configured."""
    return pytester.runpytest_inprocess("-p", "no:asyncio", *arguments)


def collected(pytester: pytest.Pytester, *arguments: str) -> list[str]:
    """Return the ids of the tests that pytest would run."""
    done = session(pytester, "--collect-only", "-q", *arguments)
    return [line for line in done.outlines if "::" in line and not line.startswith(("ERROR", "FAILED"))]


def test_nothing_changes_while_it_is_off(pytester: pytest.Pytester, bench: Path) -> None:
    pytester.makepyfile("def test_sum():\n    assert 1 + 1 == 2")
    assert collected(pytester) == ["test_nothing_changes_while_it_is_off.py::test_sum"]
    done = session(pytester, bench.name)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    assert not (pytester.path / ".robbdd").exists()


def test_an_installed_plugin_that_is_off_loads_pytest_only(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        import sys

        def test_modules():
            assert "robbdd_tools.pytest_plugin" in sys.modules
            ours = {name for name in sys.modules if name.startswith("robbdd_tools.")}
            assert ours == {"robbdd_tools.pytest_plugin"}
            assert not {"numpy", "rdflib", "textx", "mujoco", "sqlite3"}.intersection(sys.modules)
        """
    )
    plain = ["-p", "no:hypothesispytest", "-p", "no:asyncio", "-p", "no:xdist", "-p", "no:pytest-lsp"]
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *plain]
    done = subprocess.run(command, cwd=pytester.path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_an_option_without_the_switch_is_refused(pytester: pytest.Pytester) -> None:
    done = session(pytester, "--robbdd-where", "part=bolt")
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines(["*--robbdd-where needs --robbdd, or 'robbdd = true' in the ini file*"])


@pytest.mark.usefixtures("bench")
def test_each_scenario_is_a_test_with_its_values(pytester: pytest.Pytester) -> None:
    assert collected(pytester, "--robbdd") == ALL


@pytest.mark.usefixtures("bench")
def test_the_ini_file_turns_it_on(pytester: pytest.Pytester) -> None:
    pytester.makeini("[pytest]\nrobbdd = true")
    assert collected(pytester) == ALL
    assert collected(pytester, "-o", "robbdd=false") == []


@pytest.mark.usefixtures("bench")
def test_a_node_id_selects_a_scenario_or_all_of_its_variations(pytester: pytest.Pytester) -> None:
    assert collected(pytester, "--robbdd", ALL[2]) == [ALL[2]]
    assert collected(pytester, "--robbdd", FETCH) == ALL
    assert collected(pytester, "--robbdd", "bench.bdd::fetching") == ALL


@pytest.mark.usefixtures("bench")
@pytest.mark.parametrize(
    ("arguments", "numbers"),
    [
        (["-k", "nut and not tray_ws"], [2]),
        (["-m", "robbdd(agent='panda', behaviour='pick-place')"], [0, 1, 2, 3]),
        (["-m", "robbdd(agent='ur10')"], []),
        (["-m", "robbdd(template='fetch') and not robbdd(story='fetching')"], []),
        (["--robbdd-where", "goal=tray_ws"], [1, 3]),
        (["--robbdd-first", "3"], [0, 1, 2]),
        (["--robbdd-scenario", "bench-to-tray", "--robbdd-first", "1"], [0]),
    ],
)
def test_scenarios_are_selected(pytester: pytest.Pytester, arguments: list[str], numbers: list[int]) -> None:
    assert collected(pytester, "--robbdd", "--strict-markers", *arguments) == [ALL[number] for number in numbers]


@pytest.mark.parametrize("option", ["sample=2", "pairwise=2"])
def test_a_reduced_selection_is_that_of_the_plan(pytester: pytest.Pytester, bench: Path, option: str) -> None:
    name, _, number = option.partition("=")
    plan = load(bench).scenarios(seed=5, sample=int(number) if name == "sample" else None, pairwise=None)
    plan = load(bench).scenarios(seed=5, pairwise=2) if name == "pairwise" else plan
    expected = [ALL[spec.variation - 1] for spec in plan.scenarios]
    assert collected(pytester, "--robbdd", "--robbdd-seed=5", f"--robbdd-{option}") == expected


@pytest.mark.usefixtures("bench")
def test_a_repetition_has_its_number_from_the_second_on(pytester: pytest.Pytester) -> None:
    found = collected(pytester, "--robbdd", "--robbdd-repeat=3", "--robbdd-first=1")
    assert found == [ALL[0], *(ALL[0].replace("]", f"-repetition{number}]") for number in (2, 3))]


def test_executions_of_a_folder_replace_plain_scenarios(pytester: pytest.Pytester) -> None:
    shutil.copytree(EXAMPLES / "pickplace", pytester.path / "cell")
    ids = collected(pytester, "--robbdd")
    assert len(ids) == 4
    assert all(name.startswith("cell/pickplace.bddx::tidy-bench::part-to-bin[in-simulation-") for name in ids)
    assert len(collected(pytester, "--robbdd", "cell/pickplace.bdd")) == 4


@pytest.mark.usefixtures("bench")
def test_an_error_in_a_model_is_a_collection_error_with_its_place(pytester: pytest.Pytester) -> None:
    bad = MODEL.replace("obj set <parts>", "obj set <part>")
    (pytester.path / "bad.bdd").write_text(bad, encoding="utf-8")
    line = next(n for n, text in enumerate(bad.splitlines(), start=1) if "obj set <part>" in text)
    done = session(pytester, "--robbdd", "--collect-only")
    done.stdout.fnmatch_lines([f"bad.bdd:{line}:*: error: *[[]unknown-name[]]"])
    assert done.ret == pytest.ExitCode.INTERRUPTED
    assert "Traceback" not in done.stdout.str()


def test_a_warning_about_a_model_is_a_warning_of_pytest(pytester: pytest.Pytester, bench: Path) -> None:
    scene = bench.parent / "lab.scene"
    scene.write_text(SCENE.replace("object nut", "object nut, object gizmo"), encoding="utf-8")
    bench.write_text(MODEL.replace("<parts.nut>", "<parts.gizmo>"), encoding="utf-8")
    warnings = [finding for finding in load(bench).diagnostics if finding.severity.name == "WARNING"]
    assert warnings
    done = session(pytester, "--robbdd", "--collect-only")
    assert f"ModelWarning: {warnings[0]}" in done.stdout.str()


@pytest.mark.usefixtures("bench")
@pytest.mark.parametrize(
    ("option", "reason"),
    [
        ("--robbdd-where=gaol=tray_ws", "*gaol*"),
        ("--robbdd-where=goal=", "*column*"),
        ("--robbdd-where=goal=elsewhere", "no scenario fits the selection"),
        ("--robbdd-scenario=gone", "there is no scenario 'gone'; the model has bench-to-tray"),
    ],
)
def test_a_selection_of_nothing_is_an_error_not_a_pass(pytester: pytest.Pytester, option: str, reason: str) -> None:
    pytester.makepyfile("def test_sum():\n    assert 1 + 1 == 2")
    done = session(pytester, "--robbdd", option)
    done.assert_outcomes(passed=1, errors=1)
    done.stdout.fnmatch_lines([reason])
    assert "/_pytest/" not in done.stdout.str()


@pytest.mark.parametrize(
    ("option", "reason"),
    [
        (["--robbdd-first=0"], "--robbdd-first: 0 is not a number above 0"),
        (["--robbdd-repeat=-1"], "--robbdd-repeat: -1 is not a number above 0"),
        (["--robbdd-pairwise=4"], "--robbdd-pairwise: 4 is not 2 or 3"),
        (["--robbdd-timeout=inf"], "--robbdd-timeout: inf is not a number of seconds"),
        (["--robbdd-first=1", "--robbdd-sample=1"], "give only one of --robbdd-first and --robbdd-sample"),
    ],
)
def test_numbers_that_make_no_sense_are_refused(pytester: pytest.Pytester, option: list[str], reason: str) -> None:
    done = session(pytester, "--robbdd", *option)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines([f"*{reason}"])


def test_a_graph_is_collected_when_it_is_named(pytester: pytest.Pytester, bench: Path) -> None:
    graph = load(bench).graph("ttl")
    bench.unlink()
    (pytester.path / "bench.ttl").write_text(graph, encoding="utf-8")
    (pytester.path / "data.json").write_text("{}", encoding="utf-8")
    assert collected(pytester, "--robbdd") == []
    assert collected(pytester, "--robbdd", "bench.ttl") == [name.replace(".bdd", ".ttl") for name in ALL]


@pytest.mark.usefixtures("bench")
def test_a_model_without_scenarios_is_an_error_when_it_is_named(pytester: pytest.Pytester) -> None:
    library = MODEL.partition("User Story")[0]
    (pytester.path / "library.bdd").write_text(library, encoding="utf-8")
    assert collected(pytester, "--robbdd") == ALL
    done = session(pytester, "--robbdd", "library.bdd")
    done.stdout.fnmatch_lines(["*library.bdd: the model has no scenario to run"])
    assert done.ret == pytest.ExitCode.INTERRUPTED


@pytest.mark.usefixtures("bench")
def test_collecting_leaves_nothing_behind(pytester: pytest.Pytester) -> None:
    before = sorted(pytester.path.iterdir())
    collected(pytester, "--robbdd", "-p", "no:cacheprovider")
    assert sorted(pytester.path.iterdir()) == before


def named(spec: ScenarioSpec, **values: object) -> ScenarioSpec:
    return replace(spec, values=values)


def test_names_are_unique_and_short(bench: Path) -> None:
    spec, other, *_ = load(bench).scenarios().scenarios
    same = [named(spec, a="x-y", b="z"), named(other, a="x", b="y-z")]
    assert scenario_names(same) == ["bench-to-tray[x-y-z-#1]", "bench-to-tray[x-y-z-#2]"]
    (long,) = scenario_names([named(spec, a=["t:part"] * 100)])
    assert len(long) < LONGEST + 30
    assert long.endswith("-#1]")
    assert scenario_names([named(spec)]) == ["bench-to-tray"]
    assert scenario_names([named(spec, text="a\nb")]) == [r"bench-to-tray[a\nb]"]


def test_a_substitution_needs_an_implementation_of_a_collected_model(pytester: pytest.Pytester) -> None:
    shutil.copytree(EXAMPLES / "pickplace", pytester.path / "cell")
    assert collected(pytester, "--robbdd", "--robbdd-bhv", "built-in=pick-place", "cell")
    done = session(pytester, "--robbdd", "--robbdd-bhv", "server=pick-place", "--collect-only", "cell")
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    assert "there is no behaviour implementation 'server'; the executions use built-in" in done.stderr.str()
    done = session(pytester, "--robbdd", "--robbdd-bhv", "built-in", "cell")
    assert "--robbdd-bhv: 'built-in' is not NAME=BEHAVIOUR" in done.stderr.str()


def test_a_scenex_places_the_scenarios_of_its_scene(pytester: pytest.Pytester) -> None:
    shutil.copytree(EXAMPLES / "ownrobot", pytester.path / "cell")
    named = ("--robbdd", "--robbdd-scenex", "cell/cell.scenex", "--collect-only")
    assert collected(pytester, *named, "cell/tidy.bdd")
    shutil.copytree(EXAMPLES / "pickplace", pytester.path / "bench")
    done = session(pytester, *named, "bench/pickplace.bdd")
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    assert "--robbdd-scenex: no scenario runs in a scene that is instantiated: there is cell_sim" in done.stderr.str()
    done = session(pytester, "--robbdd", "--robbdd-scenex", "cell/tidy.bdd", "cell")
    assert "--robbdd-scenex: " in done.stderr.str()
    assert "tidy.bdd is not a .scenex file" in done.stderr.str()
