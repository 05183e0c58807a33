"""Logs of real robots that the executions of a ``.bddx`` name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.logs.log_files import is_log
from robbdd_tools.workbench.log_judging import LogNames

if TYPE_CHECKING:
    from collections.abc import Callable

    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Execution
    from robbdd_tools.protocol.recorded_log import RecordedLog
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.model import Model
    from robbdd_tools.workbench.plan import Selection

V = TypeVar("V")


class NoNamedLog(RobbddError):
    """A model names no log, or one that does not exist; the message says what to write."""


@dataclass(frozen=True, slots=True)
class NamedLog:
    """A log that an execution names.

    - ``execution``: the CURIE of the execution.
    - ``path``: the file or folder.
    - ``selection``: selects the scenario that the robot executed.
    - ``names``: the meaning of the names in the log.
    - ``place``: where the log is declared, as the begin of a message.
    """

    execution: str
    path: Path
    selection: Selection
    names: LogNames
    place: str = ""


def named_logs(model: Model, selection: Selection, stated: LogNames) -> list[NamedLog]:
    """Return the logs that the selected executions of a model name, in written order.

    ``stated`` has what the user states in addition; it takes precedence. Raises ``NoNamedLog``, and ``ModelErrors``
    if the model has errors.
    """
    found = every_named_log(model, selection, stated)
    for one in found:
        if not is_log(one.path):
            raise NoNamedLog(f"{one.place}there is no log at {one.path}: record one there, or change 'path:'")
    if not found:
        raise NoNamedLog(
            f"no selected execution of {model.path} names a log: write 'log: <NAME>' in a 'Scenario Exec', "
            "or name the log: robbdd judge LOG FILE"
        )
    return found


def every_named_log(model: Model, selection: Selection, stated: LogNames) -> list[NamedLog]:
    """Return the logs that the selected executions name, as ``named_logs``, also those that do not exist."""
    return list(_named_logs(model, selection, stated))


def _named_logs(model: Model, selection: Selection, stated: LogNames) -> Iterator[NamedLog]:
    for file in model.runnable:
        acceptance = file.acceptance
        for execution in acceptance.executions:
            log = execution.log
            if log is None or not _is_selected(acceptance, execution, selection.names):
                continue
            path = _path_of(log, log.path)
            name = acceptance.curie(execution.iri)
            chosen = replace(selection, names=(name,), is_wanted=_executed(acceptance, log, selection.is_wanted))
            yield NamedLog(name, path, chosen, merged(acceptance, log, stated), _place(log))


def names_for(model: Model, spec: ScenarioSpec, stated: LogNames) -> LogNames:
    """Return the names of the log of a scenario's execution, together with those that the user states.

    They also apply to other recordings of the same cell.
    """
    wanted = "" if spec.execution is None else spec.execution.iri
    for file in model.runnable:
        for execution in file.acceptance.executions:
            if execution.iri == wanted and execution.log is not None:
                return merged(file.acceptance, replace(execution.log, annotations=""), stated)
    return stated


def merged(model: AcceptanceModel, log: RecordedLog, stated: LogNames) -> LogNames:
    """Return the names of a log, completed and replaced by those that the user states."""

    def elements(pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
        return {model.curie(element): name for name, element in pairs}

    errors = {model.curie(name): size for name, size in log.errors}
    annotations = _path_of(log, log.annotations) if log.annotations else None
    return replace(
        stated,
        frames=_with(elements(log.frames), stated.frames),
        bases=_with(elements(log.bases), stated.bases),
        joint_topics=_with(elements(log.joints), stated.joint_topics),
        world=stated.world or log.world,
        signals=(*(f"{model.curie(event)}={signal}" for event, signal in log.events), *stated.signals),
        grips=(*(f"{model.curie(agent)}={signal}" for agent, signal in log.grips), *stated.grips),
        uncertainty=_with(errors, stated.uncertainty),
        annotations=stated.annotations or annotations,
    )


def _with(own: dict[str, V], stated: Mapping[str, V]) -> dict[str, V]:
    """Return a log's mapping of elements in which what the user states, by CURIE or local name, takes precedence."""
    added = dict(stated)
    kept = {name: value for name, value in own.items() if not {name, name.rpartition(":")[2]} & added.keys()}
    return {**kept, **added}


def _is_selected(model: AcceptanceModel, execution: Execution, names: Sequence[str]) -> bool:
    iris = (execution.iri, execution.variant)
    known = {word for iri in iris for word in (str(iri), model.curie(iri), model.curie(iri).rpartition(":")[2])}
    return not names or not known.isdisjoint(names)


def _executed(
    model: AcceptanceModel, log: RecordedLog, also: Callable[[ScenarioSpec], bool] | None
) -> Callable[[ScenarioSpec], bool]:
    """Return whether a scenario has the values with which the robot executed it."""
    wanted = {model.curie(variable): _curie(model, value) for variable, value in log.values}

    def is_executed(spec: ScenarioSpec) -> bool:
        return all(spec.values.get(name) == value for name, value in wanted.items()) and (also is None or also(spec))

    return is_executed


def _curie(model: AcceptanceModel, value: str | float) -> str | float:
    from robbdd_tools.graph.acceptance_model import Iri

    return model.curie(value) if isinstance(value, Iri) else value


def _path_of(log: RecordedLog, path: str) -> Path:
    folder = Path() if log.origin is None else Path(log.origin.file).parent
    return folder / Path(path).expanduser()


def _place(log: RecordedLog) -> str:
    return "" if log.origin is None else f"{log.origin}: "
