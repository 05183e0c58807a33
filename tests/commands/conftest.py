"""Commands, and the agents that they start, are forks."""

import pytest


@pytest.fixture(autouse=True)
def quick_start(forked_processes: None) -> None:
    """Start ``fork_kit.ROBBDD`` as a fork."""
