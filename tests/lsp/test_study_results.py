"""The executions of a study in an editor, although the command line has executed it."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from pygls.exceptions import JsonRpcException
from pytest_lsp import LanguageClient

from campaign.study_agents import QuickAgent, write_study
from kit import schema_errors
from lsp_kit import CLIENTS, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.campaign.replayed_executions import replay_of, replays_in
from robbdd_tools.campaign.study_place import open_results, study_folder
from robbdd_tools.cli import main
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run import scheduler


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    path = write_study(tmp_path / "studied")
    assert main(["study", "run", str(path)]) == 1
    return path


async def asked(client: LanguageClient, method: str, **params: object) -> Any:
    return plain(await client.protocol.send_request_async(method, params))


@CLIENTS
async def test_the_executions_of_the_command_line_are_listed(client: LanguageClient, study: Path) -> None:
    found = await asked(client, "robbdd/study", uri=path_to_uri(study))
    assert schema_errors("study.schema.json", found) == []
    assert (found["name"], found["total"], found["running"], len(found["executions"])) == ("fetching", 40, False, 40)
    with open_results(study_folder(study)) as store:
        failing = {one.number for one in store.executions(failures=True)}
    assert {one["number"] for one in found["executions"] if one["verdict"] != "holds"} == failing != set()
    assert Counter(one["verdict"] for one in found["executions"]) == Counter(found["counts"])
    (one,) = (one for one in found["executions"] if one["number"] == min(failing))
    assert "behaviour of fetch" in {clause["name"] for clause in one["clauses"]}


@CLIENTS
async def test_what_has_no_results_or_no_recording_is_refused_with_the_command_that_makes_them(
    client: LanguageClient, study: Path
) -> None:
    other = write_study(study.parent.parent / "other")
    with pytest.raises(JsonRpcException, match="`robbdd study run` begins it"):
        await asked(client, "robbdd/study", uri=path_to_uri(other))
    with pytest.raises(JsonRpcException, match="is not the file of a study"):
        await asked(client, "robbdd/study", uri=path_to_uri(other.parent / "m.bdd"))
    with pytest.raises(JsonRpcException, match="no recording of execution 3: `robbdd study replay FILE 3` makes one"):
        await asked(client, "robbdd/trace", uri=path_to_uri(study), number=3)


def test_an_execution_that_was_executed_again_is_found_by_its_number(study: Path) -> None:
    store = replays_in(study_folder(study))
    assert main(["study", "replay", str(study), "17", "3"]) == 0
    assert replay_of(store, 3) is None, "the agent of this test makes no traces"
    (run,) = store.runs()
    for index in (0, 1):
        trace_file(run.folder, index).parent.mkdir(exist_ok=True)
        trace_file(run.folder, index).write_bytes(b"trace")
    with open_results(study_folder(study)) as results:
        seeds = {one.number: one.seed for one in results.executions()}
    specs = read_manifest(run.folder).scenarios
    for number in (3, 17):
        found = replay_of(store, number)
        assert found is not None
        assert specs[found[1]].seed == seeds[number]
    assert replay_of(store, 4) is None
    # Other files do not show what the study executed.
    assert main(["study", "replay", str(study), "5", "--force"]) == 0
    trace_file(store.runs()[-1].folder, 0).parent.mkdir(exist_ok=True)
    trace_file(store.runs()[-1].folder, 0).write_bytes(b"trace")
    assert replay_of(store, 5) is None
