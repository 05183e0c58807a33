"""Settings of all tests."""

import os
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, Phase, settings

from fork_kit import fork_server

# Tests share the cores with one another: how long an example takes says nothing about the code. In continuous
# integration the examples are the same in every run; elsewhere new ones are tried.
settings.register_profile(
    "robbdd", deadline=None, derandomize="CI" in os.environ, suppress_health_check=[HealthCheck.too_slow]
)
# Mutants are only to be noticed: the smallest example that fails is not looked for.
settings.register_profile(
    "mutants", parent=settings.get_profile("robbdd"), database=None, phases=(Phase.explicit, Phase.generate)
)
settings.load_profile("robbdd")


@pytest.fixture(scope="session")
def forks() -> Iterator[None]:
    """What ``ROBBDD`` and ``ROBBDD_LSP`` of ``fork_kit`` need."""
    with fork_server():
        yield
