"""Watch the windows of a scenario's clauses while it executes. Nothing here affects the execution or its verdicts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.agent.on_demand_quantities import OnDemandQuantities
from robbdd_tools.catalog.coordination import END, START, emitter
from robbdd_tools.judging.margin_curves import fluent_margins, unit_of
from robbdd_tools.judging.scenario_clauses import iteration_of, iteration_of_event
from robbdd_tools.monitor.curve import Curve, with_points
from robbdd_tools.monitor.judge import WindowEvidence
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.windows_so_far import WindowSoFar, windows_so_far
from robbdd_tools.protocol.clauses import Fluent, Junction, leaves_of
from robbdd_tools.protocol.pauses import Hit, Moment, PartState

if TYPE_CHECKING:
    from robbdd_tools.agent.execution import Execution
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.clauses import BehaviourCall, Clause
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

OWN_EVALUATORS = "robbdd_tools.catalog."
"""Only evaluators of this package are called during an execution: users' code may have effects."""
IN_PYTHON = "Python code judges it, when its window has closed"


@dataclass(frozen=True, slots=True)
class WatchedClauses:
    """The clauses of a scenario by feature line, in the form in which they are judged.

    ``clauses`` are Given and Then clauses, ``calls`` behaviours, and ``events`` the names of awaited events.
    """

    clauses: Mapping[int, Clause]
    calls: Mapping[int, BehaviourCall]
    events: Mapping[int, str]


@dataclass(slots=True)
class _Part:
    """A fluent, its number in the clause, and the windows with moments that have been reported.

    If ``some_time`` is true, one sample can satisfy the clause; otherwise, one sample can violate it.
    """

    line: int
    number: int
    fluent: Fluent
    negated: bool
    iri: str
    reported: set[tuple[int, Moment]] = field(default_factory=set[tuple[int, Moment]])

    @property
    def some_time(self) -> bool:
        return self.fluent.time.some_time != self.negated

    @property
    def is_measured(self) -> bool:
        """Whether its margin is known before its window has closed."""
        conditions = () if self.fluent.condition is None else (self.fluent.condition.predicate,)
        evaluators = [one.evaluate for one in (self.fluent.predicate, *conditions)]
        return all(getattr(one, "__module__", "").startswith(OWN_EVALUATORS) for one in evaluators)


class ClauseWatch:
    """Finds the moments of a scenario's clauses in its trace so far. Each moment is reported once."""

    def __init__(self, spec: ScenarioSpec, watched: WatchedClauses, execution: Execution) -> None:
        self._spec = spec
        self._watched = watched
        self._execution = execution
        # Measurements of the execution's own sampler would appear in its trace.
        self._quantities = OnDemandQuantities(execution.simulation)
        self._known = {clause.line: clause for clause in spec.clauses}
        self._parts = [
            part for line, clause in watched.clauses.items() for part in _parts(line, clause, self._known.get(line))
        ]
        self._reported: set[tuple[int, Moment]] = set()

    def moments(self) -> Iterator[Hit]:
        """Yield the moments that have been reached since the last call."""
        trace = self._execution.trace
        for part in self._parts:
            for found in self._windows(part, trace):
                for moment in self._reached(part, found, trace):
                    if (found.number, moment) not in part.reported:
                        part.reported.add((found.number, moment))
                        yield Hit(part.line, part.number, moment)
        for line, (begin, end) in self._intervals().items():
            for time, moment in ((begin, Moment.OPENS), (end, Moment.CLOSES)):
                if time is not None and (line, moment) not in self._reported:
                    self._reported.add((line, moment))
                    yield Hit(line, 0, moment)

    def judged(self, line: int, *, violated: bool) -> Iterator[Hit]:
        """Yield the moments of a clause that Python code judges: only the verdict shows them."""
        parts = [part for part in self._parts if part.line == line]
        for part in parts:
            if violated and not part.is_measured:
                yield Hit(line, part.number, Moment.NEGATIVE)
        if not parts and line in self._watched.clauses:
            yield Hit(line, 0, Moment.CLOSES)
            if violated:
                yield Hit(line, 0, Moment.NEGATIVE)

    def open_parts(self) -> set[tuple[int, int]]:
        """Return the fluents with an open window, each by the line of its clause and its number."""
        trace = self._execution.trace
        found = {
            (part.line, part.number)
            for part in self._parts
            if any(not one.closed for one in self._windows(part, trace))
        }
        intervals = self._intervals().items()
        return found | {(line, 0) for line, (begin, end) in intervals if begin is not None and end is None}

    def states(self) -> dict[int, tuple[PartState, ...]]:
        """Return the state of each clause by its feature line."""
        trace = self._execution.trace
        found: dict[int, tuple[PartState, ...]] = dict.fromkeys(self._watched.clauses, ())
        for part in self._parts:
            found[part.line] = (*found[part.line], self._state(part, trace))
        for line, (begin, end) in self._intervals().items():
            found[line] = (PartState("", begin, end),)
        return found

    def curves(self) -> dict[int, list[dict[str, Any]]]:
        """Return the margins so far over time, as data, by feature line; open windows end now."""
        trace = self._execution.trace
        found: dict[int, list[dict[str, Any]]] = {}
        for part in self._parts:
            windows = self._windows(part, trace)
            drawn = Curve(reason="" if windows else "its window has not opened", negated=part.negated)
            if windows:
                rows = windows[-1].rows
                drawn = replace(drawn, start=float(trace.times[rows.first]), end=float(trace.times[rows.last]))
                margins = self._margins(part, rows, trace)
                if margins is not None:
                    unit = unit_of(part.fluent, trace, self._execution.regions)
                    own = -margins if part.negated else margins
                    drawn = with_points(replace(drawn, unit=unit), trace.times[rows.first : rows.last + 1], own)
            found.setdefault(part.line, []).append(asdict(drawn))
        for line, (begin, end) in self._intervals().items():
            last = trace.end if end is None else end
            found[line] = [] if begin is None else [asdict(Curve(begin, last))]
        return found

    def _windows(self, part: _Part, trace: Trace) -> Sequence[WindowSoFar]:
        return () if trace.unreached else windows_so_far(part.fluent.time, trace)

    def _reached(self, part: _Part, found: WindowSoFar, trace: Trace) -> Iterator[Moment]:
        yield Moment.OPENS
        if (found.number, Moment.CLOSES) in part.reported:
            return
        if (found.number, Moment.NEGATIVE) not in part.reported and (found.closed or not part.some_time):
            margins = self._margins(part, found.rows, trace)
            if margins is not None and (margins.max() if part.some_time else margins.min()) < 0:
                yield Moment.NEGATIVE
        if found.closed:
            yield Moment.CLOSES

    def _state(self, part: _Part, trace: Trace) -> PartState:
        windows = self._windows(part, trace)
        state = PartState(part.iri, some_time=part.some_time)
        if not windows:
            return state
        # If there is a window for each occurrence, the last one is shown.
        rows, closed = windows[-1].rows, windows[-1].closed
        times = trace.times[rows.first : rows.last + 1]
        state = replace(state, opened=float(times[0]), closed=float(times[-1]) if closed else None)
        margins = self._margins(part, rows, trace)
        if margins is None:
            return replace(state, note="" if part.is_measured else IN_PYTHON)
        state = replace(state, unit=unit_of(part.fluent, trace, self._execution.regions))
        if not np.isfinite(margins).any():
            return replace(state, note="its condition has not held in the window")
        decisive = int(margins.argmax() if part.some_time else margins.argmin())
        return replace(
            state,
            margin=_finite(margins[-1]),
            decisive=_finite(margins[decisive]),
            decisive_at=float(times[decisive]),
        )

    def _margins(self, part: _Part, rows: Window, trace: Trace) -> FloatArray | None:
        """Return the margins (n,) in a window, positive where they satisfy the clause; ``None`` if they are unknown."""
        if not part.is_measured:
            return None
        try:
            evidence = WindowEvidence(self._measured(part.fluent, rows, trace), rows, self._execution.regions)
            margins = fluent_margins(part.fluent, evidence)
        except Exception:  # no record, an empty set, a wrong setting: the verdict reports it
            return None
        return -margins if part.negated else margins

    def _measured(self, fluent: Fluent, rows: Window, trace: Trace) -> Trace:
        """Return a trace with the quantities that are measured on demand. Raises ``KeyError``."""
        complete = self._execution.complete(trace)
        self._quantities.measure(fluent, trace, range(rows.first, rows.last + 1))
        return self._quantities.added_to(complete)

    def _intervals(self) -> dict[int, tuple[float | None, float | None]]:
        """Return when the behaviours and events of the When clauses begin and end (s), as far as known."""
        found: dict[int, tuple[float | None, float | None]] = {}
        stamps = self._execution.course.stamps
        in_tree = self._spec.tree is not None
        for index, (line, call) in enumerate(self._watched.calls.items(), start=1):
            names = call.behaviour.events[0], call.behaviour.events[-1]
            iteration = iteration_of(self._known.get(line)) if call.part else index
            if call.part:
                names = emitter(call.part, names[0]), emitter(call.part, names[1])
            if self._spec.node:
                names = emitter(self._spec.node, START), emitter(self._spec.node, END)
            own = [stamp for stamp in stamps if in_tree or not iteration or stamp.iteration == iteration]
            begin, end = (min((one.time for one in own if one.name == name), default=None) for name in names)
            found[line] = begin, end
        trace = self._execution.trace
        for line, event in self._watched.events.items():
            time = trace.event_time(event, iteration_of_event(event, self._known.get(line), self._spec))
            found[line] = time, time
        return found


def _parts(line: int, clause: Clause, known: ClauseSpec | None) -> Iterator[_Part]:
    """Yield the fluents of a clause. Fluents and texts share one numbering, in the order of the sentence."""
    iris = () if known is None else known.parts or (known.iri,)
    for number, (leaf, negated) in enumerate(_signed(clause)):
        if isinstance(leaf, Fluent) and leaf.predicate.evaluate is not None:
            yield _Part(line, number, leaf, negated, iris[number] if number < len(iris) else leaf.iri)


def _signed(clause: Clause, negated: bool = False) -> Iterator[tuple[Clause, bool]]:
    """Yield the fluents and texts of a clause in the order of ``leaves_of``, and whether the clause negates them."""
    if not isinstance(clause, Junction):
        yield from ((leaf, negated) for leaf in leaves_of(clause))
        return
    for operand in clause.operands:
        yield from _signed(operand, negated != (clause.operator == "not"))


def _finite(value: float) -> float | None:
    """Return a number that JSON can hold."""
    return float(value) if np.isfinite(value) else None
