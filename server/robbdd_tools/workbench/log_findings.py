"""Findings about the logs that a ``.bddx`` names: names that a log does not contain, and things that it lacks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.quantity_units import dimension_of
from robbdd_tools.catalog.coordination import DEFINED
from robbdd_tools.checks.finding import MAX_OFFERED
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.logs.log_files import SUFFIXES, is_log, log_path
from robbdd_tools.logs.summary_cache import obtain
from robbdd_tools.names.elements import Site
from robbdd_tools.protocol.event_signals import read_event_signal
from robbdd_tools.protocol.grip_signals import read_grip_signal
from robbdd_tools.protocol.recorded_log import ERROR_KEYS
from robbdd_tools.syntax import tree
from robbdd_tools.workbench.diagnostics import findings

if TYPE_CHECKING:
    from robbdd_tools.logs.log_summary import LogSummary
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.diagnostics import Finding
    from robbdd_tools.workbench.model import Model

CODE = "log-name"
MIN_ALIKE = 0.5
"""Minimum similarity of a suggestion."""
MAX_NAMES = 8
"""Maximum number of names of a log that a message lists."""
_ENDS = ("scenario-start", "scenario-end")


def log_findings(snapshot: Snapshot, uri: str) -> list[Diagnostic]:
    """Return the findings about the logs that a ``.bddx`` names.

    The first time, each log is read by another process, which takes as long as decoding it; then its names are known
    until the log changes.
    """
    file = snapshot.file(uri)
    if file is None:
        return []
    found: list[Diagnostic] = []
    for placed in file.of(tree.RobotLog, tree.Execution):
        site = Site(snapshot, file, placed)
        if placed.declaration.faults:
            continue
        if isinstance(site.tree, tree.RobotLog):
            found += _of_log(site, site.tree)
        elif isinstance(site.tree, tree.Execution) and site.tree.log is not None:
            found += _of_execution(site, site.tree, site.tree.log)
    return found


def all_log_findings(model: Model) -> tuple[Finding, ...]:
    """Return the findings about the logs that the files of a model, and those that they import, name."""
    found: dict[Finding, None] = {}
    for file in model.files:
        for one in file.snapshot.closure(file.uri):
            found |= dict.fromkeys(findings(file.snapshot, log_findings(file.snapshot, one.document.uri)))
    return tuple(found)


def _of_log(site: Site, log: tree.RobotLog) -> Iterator[Diagnostic]:
    for error in log.errors:
        dimension = dimension_of(error.size.text)
        if dimension not in ERROR_KEYS or (error.target is not None and dimension != "length"):
            wanted = "a length" if error.target is not None else "a length, an angle or a speed"
            message = f"'{error.size.text}' is no largest error of a measurement: write {wanted}, such as '3 mm'"
            yield _finding(site, error.size, Severity.ERROR, message)
    summary = summary_of(site, log)
    if isinstance(summary, str):
        yield _finding(site, log.path, Severity.WARNING, summary)
        return
    annotations = None if log.annotations is None else log_path(site.uri, log.annotations.value)
    if log.annotations is not None and (annotations is None or not annotations.is_file()):
        message = f"there is no table at {annotations}: write a CSV file with the columns time and event"
        yield _finding(site, log.annotations, Severity.WARNING, message)
    frames = summary.names_of_frames()
    for mapping in (*log.frames, *log.bases):
        yield from _unknown(site, mapping.text, mapping.text.value.lstrip("/"), frames, "frame")
    if log.world is not None:
        yield from _unknown(site, log.world, log.world.value.lstrip("/"), frames, "frame")
    for mapping in log.joints:
        yield from _unknown(site, mapping.text, mapping.text.value, summary.joints, "topic of joint states")
    for event in log.events:
        yield from _of_event(site, event, summary)
    for grip in log.grips:
        yield from _of_grip(site, grip, summary)


def summary_of(site: Site, log: tree.RobotLog) -> LogSummary | str:
    """Return the summary of a log, or why there is none."""
    path = log_path(site.uri, log.path.value)
    if path is None or not is_log(path):
        forms = f"a rosbag2 folder, or a file {', '.join(SUFFIXES)}"
        return f"there is no log at {path}: name {forms}; robbdd judge needs it"
    summary = obtain(path)
    return summary.problem or summary


def _of_event(site: Site, event: tree.LogEvent, summary: LogSummary) -> Iterator[Diagnostic]:
    try:
        signal = read_event_signal(f"{event.event.path}={event.signal.value}")
    except ValueError as error:
        yield _finding(site, event.signal, Severity.ERROR, str(error).replace("EVENT=", ""))
        return
    missing = list(_unknown(site, event.signal, signal.topic, summary.topics, "topic"))
    yield from missing
    fields = {} if missing else dict(summary.topics[signal.topic].fields)
    if fields and signal.kind != "message" and not any(_same_field(signal.field, one) for one in fields):
        yield from _unknown(site, event.signal, signal.field, fields, f"field of {signal.topic}")


def _same_field(stated: str, field: str) -> bool:
    """Return whether a path of fields is one of a type. Its arrays are listed with their first element."""
    from re import sub

    return sub(r"\[\d+\]", "[0]", stated) == field or field.startswith(f"{stated}.")


def _of_grip(site: Site, grip: tree.LogGrip, summary: LogSummary) -> Iterator[Diagnostic]:
    try:
        signal = read_grip_signal(f"{grip.agent.path}={grip.signal.value}")
    except ValueError as error:
        yield _finding(site, grip.signal, Severity.ERROR, str(error).replace("AGENT=", ""))
        return
    if signal.kind in ("joint", "effort"):
        joints = [name for names in summary.joints.values() for name in names]
        yield from _unknown(site, grip.signal, signal.source, joints, "joint")
    else:
        yield from _unknown(site, grip.signal, signal.source, summary.topics, "topic")


def _unknown(site: Site, text: tree.Text, name: str, known: Iterable[str], kind: str) -> Iterator[Diagnostic]:
    """Yield the finding that a log does not contain a name, with similar names as fixes."""
    names = sorted(known)
    if name in names:
        return
    near = get_close_matches(name, names, n=MAX_OFFERED, cutoff=MIN_ALIKE)
    listed = ", ".join(near or names[:MAX_NAMES])
    has = f"; nearest: {listed}" if near else f"; it has: {listed}" if names else ": it has none"
    written = site.file.document.text[site.span(text).start : site.span(text).end]
    fixes = tuple(
        Fix(f"Change to '{one}'", (Edit(site.uri, site.span(text), written.replace(name, one, 1)),)) for one in near
    )
    yield _finding(site, text, Severity.WARNING, f"the log has no {kind} '{name}'{has}", fixes)


def _of_execution(site: Site, execution: tree.Execution, reference: tree.Ref) -> Iterator[Diagnostic]:
    """Yield what is missing in the log of an execution: things without a frame, and events that nothing reports."""
    log = site.follow(reference)
    if log is None or not isinstance(log.tree, tree.RobotLog):
        return
    summary = summary_of(log, log.tree)
    specs = None if isinstance(summary, str) else _specs(site, execution)
    if isinstance(summary, str) or specs is None:
        return
    if len(specs) != 1:
        message = (
            f"a log is of one execution, but {len(specs)} scenarios fit: state the values that the robot executed in "
            f"'robot log {log.tree.name.text}': where <template.variable> = <element> and …"
        )
        yield _finding(site, reference, Severity.WARNING, message)
        return
    (spec,) = specs
    for problem in (*_unplaced(spec, log.tree, summary), *_unreported(spec, log.tree, summary)):
        yield _finding(site, reference, Severity.INFORMATION, problem)


def _specs(site: Site, execution: tree.Execution) -> list[ScenarioSpec] | None:
    """Return the scenarios that an execution's log may be of; ``None`` if the model has errors."""
    from robbdd_tools.workbench.log_judging import LogNames
    from robbdd_tools.workbench.model import Model, ModelFile
    from robbdd_tools.workbench.named_logs import NoNamedLog, named_logs
    from robbdd_tools.workbench.plan import Plan, Selection

    every = (one.document.uri for one in site.snapshot.closure(site.uri))
    if any(one.severity is Severity.ERROR for uri in every for one in fast_diagnostics(site.snapshot, uri)):
        return None
    path = uri_to_path(site.uri)
    if path is None:
        return None
    model = Model(path, (ModelFile(site.snapshot, site.uri, path.name),))
    try:
        found = named_logs(model, Selection((execution.name.text,)), LogNames())
        specs = Plan.of(model, found[0].selection).specs()
        return [spec for spec in specs if spec.repetition == 1]
    except NoNamedLog:
        return None
    except RobbddError:
        return []


def _unplaced(spec: ScenarioSpec, log: tree.RobotLog, summary: LogSummary) -> Iterator[str]:
    """Yield sentences about things of the scenario that have no frame in a log."""
    from robbdd_tools.logs.log_names import FramesProblem, frame_of, local_name

    stated = {one.target.reference.path.rpartition(".")[2]: one.text.value for one in log.frames}
    used = {value for value in spec.values.values() if isinstance(value, str)}
    things = [one for one in spec.scene.objects if one in used]
    agents = [] if summary.joints else [one for one in spec.scene.agents if one in used]
    for element in (*things, *agents):
        name = local_name(element)
        if name in stated:
            continue
        try:
            frame_of(element, summary.frames, {})
        except FramesProblem as problem:
            words = str(problem).partition("; name it with")[0].partition("; choose with")[0]
            kind = "obj" if element in things else "agn"
            yield f"{words}: write frames: {{ \"FRAME\" to {kind} <{name}> }} in 'robot log {log.name.text}'"


def _unreported(spec: ScenarioSpec, log: tree.RobotLog, summary: LogSummary) -> Iterator[str]:
    """Yield sentences about events that a log does not report."""
    from robbdd_tools.logs.log_contents import TextStamp
    from robbdd_tools.logs.log_names import local_name, occurrences_of

    stated = {one.event.path.rpartition(".")[2] for one in log.events}
    texts = [TextStamp("", text, 0.0) for text in summary.texts]
    for event, source in spec.events.items():
        if source == DEFINED or source in _ENDS or local_name(event) in stated or log.annotations is not None:
            continue
        if not occurrences_of(event, source, texts):
            form = f'events: {{ <{local_name(event)}> when "/topic becomes VALUE" }}'
            yield f"the log does not report {event}: its clauses are unknown; write {form}"


def _finding(site: Site, node: tree.Node, severity: Severity, message: str, fixes: tuple[Fix, ...] = ()) -> Diagnostic:
    return Diagnostic(site.uri, site.span(node), severity, CODE, message, fixes=fixes)
