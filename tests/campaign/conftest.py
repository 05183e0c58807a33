"""What the tests of campaigns share."""

from __future__ import annotations

from pathlib import Path

import pytest

from campaign.study_agents import QuickAgent, write_study
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.run import scheduler


@pytest.fixture(autouse=True)
def restored_consent(monkeypatch: pytest.MonkeyPatch) -> None:
    """A worker of a cluster forbids users' code in its process, which is the one of the tests here."""
    monkeypatch.setenv(NO_USER_CODE, "")


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A study in the working directory, whose agents need no time."""
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    return write_study(tmp_path).relative_to(tmp_path)
