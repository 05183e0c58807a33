"""The agent process ends in good order, or the run says how it ended."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.build import build_graph
from robbdd_tools.graph.read import read_model
from robbdd_tools.names.project import Project
from robbdd_tools.run.launch import LOG, Agent
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.protocol import LogLine, RunFinished, RunStarted


def test_an_agent_that_gives_up_is_not_taken_for_a_cancelled_one(tmp_path: Path) -> None:
    agent = Agent(tmp_path)
    assert [message for message in agent.messages() if not isinstance(message, LogLine)] == [RunFinished(False)]
    agent.cancel()
    assert agent.ending().startswith("the agent process ended unexpectedly with code ")
    assert "Traceback" not in (tmp_path / LOG).read_text(encoding="utf-8")


@pytest.mark.physics
def test_a_cancelled_agent_stops_and_says_so(tmp_path: Path) -> None:
    uri = path_to_uri(EXAMPLES / "pickplace" / "pickplace.bdd")
    project = Project()
    project.load(uri)
    model = read_model(build_graph(project.snapshot(), uri).graph)
    prepare(RunRequest(model, "pickplace.bdd"), tmp_path)
    agent = Agent(tmp_path)
    messages = agent.messages()
    assert isinstance(next(messages), RunStarted)
    agent.cancel()
    assert not any(isinstance(message, RunFinished) for message in messages)
    assert agent.ending() == "the run was cancelled"
