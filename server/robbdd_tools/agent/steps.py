"""The steps of behave, one for every sentence of the catalog."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import load_bytes
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.parsed_predicates import GROUP, NOT, sentence_pattern
from robbdd_tools.judging.parsed_sentences import DEFINED, OCCURS, fluent_pattern
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.clauses import MEANWHILE
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.agent.scenario_run import ScenarioRun
    from robbdd_tools.catalog.api import Predicate

TABLES = ("a set of objects", "a set of workspaces", "a set of agents", "variable scene elements")
"""Steps that list the scene for the reader; the manifest has the same data."""


_registered: set[str] = set()
"""Patterns of the sentences of named predicates."""


def register() -> None:
    """Register the steps with behave. A file in the steps folder calls this function.

    The steps are registered for all keywords. So a user can define the same step for one keyword; behave prefers this
    definition.
    """
    behave = import_module("behave")
    matchers = import_module("behave.matchers")
    matchers.use_step_matcher("re")
    try:
        for text in TABLES:
            behave.step(re.escape(text))(_accept_table)
        behave.step("the scene is set up")(_set_up)
        for predicate in load_catalog().predicates.values():
            behave.step(fluent_pattern(predicate))(_judge)
        behave.step(DEFINED)(_judge)
        behave.step(NOT)(_judge)
        behave.step(GROUP)(_judge)
        for behaviour in load_catalog().behaviours.values():
            behave.step(f"(?:{MEANWHILE})?{sentence_pattern(behaviour.sentence)}")(_execute)
        behave.step(OCCURS)(_await_event)
    finally:
        matchers.use_step_matcher("parse")


def register_named(predicates: Iterable[Predicate]) -> None:
    """Register the sentences of predicates that a model defines, each once. Users' own steps take precedence."""
    behave = import_module("behave")
    matchers = import_module("behave.matchers")
    ambiguous = import_module("behave.step_registry").AmbiguousStep
    for pattern in (fluent_pattern(predicate) for predicate in predicates):
        if pattern not in _registered:
            _registered.add(pattern)
            matchers.use_step_matcher("re")
            try:
                behave.step(pattern)(_judge)
            except ambiguous:
                pass
            finally:
                matchers.use_step_matcher("parse")


def load_steps(files: Iterable[Path], originals: Mapping[str, str] = MappingProxyType({})) -> None:
    """Register the steps of RobBDD and then those in users' files. Exceptions in these files are not caught.

    ``originals`` maps absolute paths of copies to the files that a debugger shows instead.
    """
    register()
    matchers = import_module("behave.api.step_matchers")
    names: dict[str, Any] = {"use_step_matcher": matchers.use_step_matcher, "step_matcher": matchers.step_matcher}
    import_module("behave.step_registry").setup_step_decorators(names)
    for file in files:
        shown = originals.get(str(file.resolve()))
        if shown is None:
            import_module("behave.runner_util").exec_file(str(file), dict(names))
        else:
            exec(compile(load_bytes(file), shown, "exec", dont_inherit=True), {**names, "__file__": shown})
        matchers.use_default_step_matcher()


def _accept_table(_context: Any) -> None:
    """Do nothing: the table is for the reader."""


def _set_up(context: Any) -> None:
    try:
        context.session.scenario.set_up()
    except SceneError as error:
        raise AssertionError(str(error)) from None


def _judge(context: Any, **_words: str) -> None:
    _check(context, lambda scenario, line, text: scenario.clause(line, text))


def _execute(context: Any, **_words: str) -> None:
    _check(context, lambda scenario, line, text: scenario.behaviour(line, text))


def _await_event(context: Any, **_words: str) -> None:
    _check(context, lambda scenario, line, text: scenario.event(line, text))


def _check(context: Any, judge: Callable[[ScenarioRun, int, str], Verdict]) -> None:
    """Fail the step unless its verdict is *holds*."""
    step = _present_step(context)
    try:
        verdict = judge(context.session.scenario, int(step.line), str(step.name))
    except SceneError as error:
        raise AssertionError(str(error)) from None
    if verdict.outcome is not Outcome.HOLDS:
        raise AssertionError(_in_words(verdict))


def _present_step(context: Any) -> Any:
    """Return the current step, because behave passes only its text to a step function."""
    return next(step for step in context.scenario.all_steps if step.status.is_untested())


def _in_words(verdict: Verdict) -> str:
    margin = "" if verdict.robustness is None else f"margin {verdict.robustness:.4g} {verdict.unit}".rstrip()
    at = "" if verdict.at is None else f"at {verdict.at:.2f} s"
    details = " ".join(part for part in (margin, at) if part)
    said = "; ".join(part for part in (verdict.reason, details) if part)
    return f"{verdict.outcome}: {said}" if said else str(verdict.outcome)
