"""A store of runs in a temporary folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from robbdd_tools.run.store import RunStore


@pytest.fixture
def store(tmp_path: Path) -> RunStore:
    return RunStore(tmp_path / ".robbdd" / "runs")
