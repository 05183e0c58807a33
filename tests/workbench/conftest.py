"""Agents are forks."""

import pytest


@pytest.fixture(autouse=True)
def quick_start(forked_processes: None) -> None:
    """Start agents as forks."""
