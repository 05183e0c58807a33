"""Editor, command line, Python and pytest plan and execute the same for the same request, with the same results."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

import robbdd_tools as robbdd
from fork_kit import PYTEST
from kit import EXAMPLES
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main


def compared(run: robbdd.PastRun) -> list[object]:
    """What two runs of one request have in common."""
    heads = [(one.name, one.seed, one.repetition, one.execution, one.verdict, one.duration) for one in run.results]
    return [*heads, *((one.name, one.verdict, one.margin, one.at) for result in run.results for one in result.clauses)]


Request = dict[str, Any]
"""Options of a run, named as on the command line; ``jobs`` only matters to who executes."""


def by_command_line(path: Path, request: Request) -> None:
    main(["run", str(path), *(f"--{name}={value}" for name, value in request.items())])


def by_python(path: Path, request: Request) -> None:
    names = [request["scenario"]] if "scenario" in request else []
    selection = {name: request[name] for name in ("where", "first", "sample", "pairwise", "seed") if name in request}
    plan = robbdd.load(path).scenarios(*names, **selection)
    with plan.run(repeat=request.get("repeat"), jobs=request.get("jobs")) as run:
        run.wait()


def by_pytest(path: Path, request: Request, *arguments: str) -> None:
    options = [f"--robbdd-{name}={value}" for name, value in request.items() if name != "jobs"]
    command = [*PYTEST, "-p", "no:cacheprovider", "--robbdd", str(path), *options, *arguments]
    done = subprocess.run(command, cwd=path.parent, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stdout + done.stderr


def by_pytest_workers(path: Path, request: Request) -> None:
    by_pytest(path, request, "--numprocesses=2")


DOORS = (by_command_line, by_python, by_pytest)
"""Ways to run a request that need no server."""


def same(runs: Sequence[robbdd.PastRun]) -> None:
    """Check that runs executed the same, from the manifest's first byte to the last digit of a margin."""
    first, *others = runs
    assert first.results
    for other in others:
        assert unnamed(other) == unnamed(first)
        assert planned(other) == planned(first)
        for recorded in ("path", "digest", "seed", "user_seed", "version", "simulator", "files"):
            assert getattr(other.record, recorded) == getattr(first.record, recorded)
        assert (other.status.state, other.status.counts) == (first.status.state, first.status.counts)


def unnamed(run: robbdd.PastRun) -> list[robbdd.ExecutionResult]:
    """Return the results without the path of the model, which each way of running writes as it was given."""
    return [replace(result, model="") for result in run.results]


def planned(run: robbdd.PastRun) -> list[robbdd.ScenarioSpec]:
    return [replace(spec, model="") for spec in run.place.manifest().scenarios]


@pytest.mark.physics
@pytest.mark.parametrize(
    ("model", "request_"),
    [
        ("pickplace.bdd", {"seed": 7, "repeat": 2, "where": "goal=left_ws", "sample": 1}),
        ("pickplace.bddx", {"pairwise": 2, "jobs": 2}),
        ("pickplace.bdd", {"scenario": "part-to-bin", "first": 1}),
    ],
)
async def test_every_way_of_running_a_request_gives_the_same_results(
    editor: Editor, run_messages: list[Any], model: str, request_: Request
) -> None:
    path = editor.path.with_name(model)
    # Nothing is held when the part is in the bin: some clauses are violated, with margins and instants.
    text = editor.path.read_text(encoding="utf-8")
    editor.path.write_text(text.replace("after <evt-pick-end>", "after <evt-place-end>", 1), encoding="utf-8")
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": path_to_uri(path), **request_}])
    answer = plain(await editor.client.workspace_execute_command_async(params))
    log = [entry.message.text for entry in run_messages if entry.message.type == "LogLine"]
    assert sum(line.endswith("combinations") for line in log) == ("pairwise" in request_)
    for door in DOORS:
        door(path, request_)
    runs = robbdd.runs(path)
    assert len(runs) == 1 + len(DOORS)
    assert answer["total"] == len(runs[0].results)
    same(runs)


@pytest.mark.physics
def test_every_way_of_running_a_folder_gives_the_same_results(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "cell")
    shutil.copy(EXAMPLES / "sorting" / "sorting.bdd", folder)
    shutil.copy(EXAMPLES / "sorting" / "sorter.scene", folder)
    doors = (*DOORS, by_pytest_workers)
    for door in doors:
        door(folder, {"first": 1, "seed": 3})
    runs = robbdd.runs(folder)
    assert len(runs) == len(doors)
    same(runs)
    assert {Path(result.model).name for result in runs[0].results} == {"pickplace.bddx", "sorting.bdd"}
    assert robbdd.replay(runs[-1], jobs=2).is_identical


@pytest.mark.physics
async def test_a_repeated_scenario_shows_its_pass_rate_and_reruns_only_what_failed(editor: Editor) -> None:
    variant = robbdd.load(editor.path).scenarios().scenarios[0].variant
    # Nothing is held when the part is in the bin.
    editor.open(editor.text.replace("after <evt-pick-end>", "after <evt-place-end>", 1))

    async def execute(command: str, **options: object) -> Any:
        params = types.ExecuteCommandParams(command=command, arguments=[{"uri": editor.uri, **options}])
        return plain(await editor.client.workspace_execute_command_async(params))

    only = [{"variant": variant, "variations": [1]}]
    answer = await execute("robbdd.run", only=only, repeat=3, seed=4)
    assert (answer["total"], answer["violated"]) == (3, 3)
    again = await execute("robbdd.rerunFailed")
    assert (again["total"], again["violated"]) == (3, 3)
    first, second = robbdd.runs(Path(editor.path))
    assert compared(first) == compared(second)
