"""Commands start as forks."""

import pytest


@pytest.fixture(autouse=True)
def quick_start(forks: None) -> None:
    """Start ``fork_kit.ROBBDD`` as a fork."""
