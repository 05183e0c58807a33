"""Read the plugin's options from pytest's command line."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.model import read_instances
from robbdd_tools.workbench.plan import Selection
from robbdd_tools.workbench.substitution import parse_substitution


@dataclass(frozen=True, slots=True)
class Options:
    """The options of the plugin.

    They are the selection of scenarios, the number of repetitions, the time limit of each scenario (wall time, s) and
    the place of the run.
    """

    selection: Selection
    repeat: int | None
    timeout: float | None
    keeping: Keeping


OPTIONS = pytest.StashKey[Options]()


def read_options(config: pytest.Config) -> Options:
    """Return the options; raises ``UsageError``."""

    def given(name: str) -> Any:
        return config.getoption(f"robbdd_{name}")

    for name in ("repeat", "first", "sample"):
        if given(name) is not None and given(name) < 1:
            raise pytest.UsageError(f"--robbdd-{name}: {given(name)} is not a number above 0")
    if given("pairwise") not in (None, 2, 3):
        raise pytest.UsageError(f"--robbdd-pairwise: {given('pairwise')} is not 2 or 3")
    reducing = [f"--robbdd-{name}" for name in ("first", "sample", "pairwise") if given(name) is not None]
    if len(reducing) > 1:
        raise pytest.UsageError(f"give only one of {' and '.join(reducing)}")
    timeout = given("timeout")
    if timeout is not None and not (timeout >= 0 and isfinite(timeout)):
        raise pytest.UsageError(f"--robbdd-timeout: {timeout} is not a number of seconds")
    names = tuple(given("scenario") or ())
    try:
        substitutions = dict(map(parse_substitution, given("bhv") or ()))
    except SelectionError as error:
        raise pytest.UsageError(f"--robbdd-bhv: {error}") from None
    try:
        instances = read_instances(config.invocation_params.dir / name for name in given("scenex") or ())
    except RobbddError as error:
        raise pytest.UsageError(f"--robbdd-scenex: {error}") from None
    selection = Selection(
        names,
        given("where"),
        given("first"),
        given("sample"),
        given("pairwise"),
        given("seed"),
        default_substitutions=substitutions,
        default_instances=instances,
    )
    store = None if given("store") is None else Path(given("store")).absolute()
    return Options(selection, given("repeat"), timeout, Keeping(store=store, keep=not given("no_store")))
