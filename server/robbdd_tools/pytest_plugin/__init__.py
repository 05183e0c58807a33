"""Pytest plugin: each execution of a scenario is a test (see ``docs/pytest.md``).

Pytest loads this module in every session of an environment in which the package is installed. Unless ``--robbdd`` or
the ini setting ``robbdd`` enables the plugin, it only adds its options and imports nothing else.
"""

from __future__ import annotations

import pytest

DEFAULTS: dict[str, object] = {
    "robbdd_scenario": None,
    "robbdd_seed": None,
    "robbdd_repeat": None,
    "robbdd_bhv": None,
    "robbdd_scenex": None,
    "robbdd_where": None,
    "robbdd_first": None,
    "robbdd_sample": None,
    "robbdd_pairwise": None,
    "robbdd_timeout": None,
    "robbdd_store": None,
    "robbdd_no_store": False,
}
"""Default values of the options that require ``--robbdd``."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options, named like those of ``robbdd run``."""
    text = "collect and run the scenarios of RobBDD models (.bdd, .bddx) as tests"
    parser.addini("robbdd", f"{text}: true or false", type="bool", default=False)
    group = parser.getgroup("robbdd", "RobBDD: acceptance tests of robots")
    group.addoption("--robbdd", action="store_true", default=False, help=text)
    text = "only this scenario or execution; repeats"
    group.addoption("--robbdd-scenario", metavar="NAME", action="append", help=text)
    group.addoption("--robbdd-seed", metavar="N", type=int, help="seed of all random choices (default: 1)")
    text = "execute each scenario N times, each with a different random seed"
    group.addoption("--robbdd-repeat", metavar="N", type=int, help=text)
    text = "execute a catalog behaviour instead of this implementation of a .bddx, such as a ROS action; repeats"
    group.addoption("--robbdd-bhv", metavar="NAME=BEHAVIOUR", action="append", help=text)
    text = "run scenarios without an execution in the scene instance of this .scenex for their scene; repeats"
    group.addoption("--robbdd-scenex", metavar="FILE", action="append", help=text)
    text = "only scenarios with these values: 'robot=panda and target=~cube.*'"
    group.addoption("--robbdd-where", metavar="EXPRESSION", help=text)
    group.addoption("--robbdd-first", metavar="N", type=int, help="only the first N of each scenario's variations")
    text = "N variations of each scenario, drawn at random with the seed"
    group.addoption("--robbdd-sample", metavar="N", type=int, help=text)
    text = "a small set of variations that covers all value combinations of any 2 or 3 variables"
    group.addoption("--robbdd-pairwise", metavar="2|3", type=int, help=text)
    text = "wall time limit of each scenario in seconds (default: 300; 0: no limit)"
    group.addoption("--robbdd-timeout", metavar="SECONDS", type=float, help=text)
    text = "where the run is kept (default: .robbdd/runs in the project's root)"
    group.addoption("--robbdd-store", metavar="DIR", help=text)
    group.addoption("--robbdd-no-store", action="store_true", default=False, help="do not store the run")


def pytest_configure(config: pytest.Config) -> None:
    """If the plugin is enabled, register the hooks that collect and run scenarios. Raises ``UsageError``."""
    if config.getoption("robbdd") or config.getini("robbdd"):
        from robbdd_tools.pytest_plugin.session_hooks import Hooks

        config.pluginmanager.register(Hooks(config), "robbdd-hooks")
        return
    given = [name for name, default in DEFAULTS.items() if config.getoption(name) != default]
    if given:
        option = f"--{given[0].replace('_', '-')}"
        raise pytest.UsageError(f"{option} needs --robbdd, or 'robbdd = true' in the ini file")
