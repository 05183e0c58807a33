"""A pytest plugin: runs the quickest tests first, by the durations that mutmut measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

DURATIONS = Path("mutmut-stats.json")
"""Written by mutmut after its first run of all tests, into the folder from which it starts pytest."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort the tests by their durations in seconds; unmeasured tests come first."""
    if DURATIONS.exists():
        durations: dict[str, float] = json.loads(DURATIONS.read_text(encoding="utf-8"))["duration_by_test"]
        items.sort(key=lambda item: durations.get(item.nodeid, 0.0))
