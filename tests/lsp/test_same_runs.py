"""For the same request the editor and the command line execute the same and come to the same results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

import robbdd_tools as robbdd
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main


def compared(run: robbdd.PastRun) -> list[object]:
    """What two runs of one request have in common."""
    heads = [(one.name, one.seed, one.repetition, one.execution, one.verdict, one.duration) for one in run.results]
    return [*heads, *((one.name, one.verdict, one.margin, one.at) for result in run.results for one in result.clauses)]


@pytest.mark.physics
@pytest.mark.parametrize(
    ("model", "options", "arguments"),
    [
        ("pickplace.bdd", {"seed": 7, "repeat": 2, "where": "goal=left_ws", "sample": 1}, []),
        ("pickplace.bddx", {"pairwise": 2, "jobs": 2}, []),
        ("pickplace.bdd", {"only": [], "first": 1}, ["--scenario", "part-to-bin"]),
    ],
)
async def test_editor_and_command_line_get_the_same_results(
    editor: Editor,
    run_messages: list[Any],
    capsys: pytest.CaptureFixture[str],
    model: str,
    options: dict[str, Any],
    arguments: list[str],
) -> None:
    path = editor.path.with_name(model)
    if "only" in options:
        variant = robbdd.load(path).scenarios().scenarios[0].variant
        options = {**options, "only": [{"variant": variant}]}
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": path_to_uri(path), **options}])
    answer = plain(await editor.client.workspace_execute_command_async(params))
    given = [f"--{name}={value}" for name, value in options.items() if name != "only"]
    main(["run", str(path), *arguments, *given])
    log = [entry.message.text for entry in run_messages if entry.message.type == "LogLine"]
    coverage = [text for text in log if text.endswith("combinations")]
    assert len(coverage) == ("pairwise" in options)
    assert all(line in capsys.readouterr().err for line in coverage)
    by_editor, by_command_line = robbdd.runs(path)
    assert by_editor.number == answer["stored"]["run"]
    assert compared(by_editor) == compared(by_command_line)
    assert answer["total"] == len(by_editor.results) > 0
    for recorded in ("digest", "seed", "version", "files"):
        assert getattr(by_editor.record, recorded) == getattr(by_command_line.record, recorded)


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
