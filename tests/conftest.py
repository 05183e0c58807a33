"""Settings of all tests."""

import gc
import os
import sys
import tempfile
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, Phase, settings

from fork_kit import CAN_FORK, INTERPRETERS, fork_server
from robbdd_tools.base.memory import collect_rarely
from robbdd_tools.campaign import rates

# Tests neither read nor fill the user's cache.
os.environ.setdefault("ROBBDD_CACHE", tempfile.mkdtemp(prefix="robbdd-cache-"))

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


def pytest_xdist_auto_num_workers() -> int:
    """One worker more than there are processors: some tests mostly wait for other processes."""
    return (os.cpu_count() or 1) + 1


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave the long forms of tests to ``make nightly``, which asks for their marker."""
    if "nightly" in str(config.getoption("markexpr")):
        return
    long = [item for item in items if item.get_closest_marker("nightly") is not None]
    if long:
        config.hook.pytest_deselected(items=long)
        items[:] = [item for item in items if item.get_closest_marker("nightly") is None]


def pytest_collection_finish() -> None:
    """Search for reference cycles as rarely as the product does, and never among what the collection of tests made."""
    gc.collect()
    gc.freeze()
    collect_rarely()


@pytest.fixture(scope="session")
def forks() -> Iterator[None]:
    """What ``ROBBDD`` and ``ROBBDD_LSP`` of ``fork_kit`` need."""
    with fork_server():
        yield


@pytest.fixture
def forked_processes(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let this process start agents and validation processes as forks."""
    request.getfixturevalue("forks")
    if CAN_FORK:
        monkeypatch.setattr(*INTERPRETERS)


@pytest.fixture
def without_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    """SciPy cannot be imported, and no figure is remembered from before."""
    monkeypatch.setitem(sys.modules, "scipy.stats", None)
    for function in (rates.rate_interval, rates.paired_interval, rates.paired_probability, rates.separate_probability):
        function.cache_clear()
