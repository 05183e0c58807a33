"""Pauses of an execution: the orders of a debugger, and the scenario's state that the agent reports.

Times are in s of simulated time, positions in m in the world frame, orientations are unit quaternions (w, x, y, z),
joint positions in the units of the joints (rad, m).
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from enum import StrEnum

from robbdd_tools.base.plain import from_plain


class Moment(StrEnum):
    """A moment of a clause at which the execution can pause.

    A clause that only Python code judges closes when it is judged, and turns negative if the verdict is *violated*.
    """

    OPENS = "opens"
    """The window of one of the clause's fluents opens, or the behaviour of a When clause begins."""
    CLOSES = "closes"
    """The window closes, or the behaviour ends."""
    NEGATIVE = "turns negative"
    """The margin is negative for the first time in the window, or it is certain that the clause is violated."""


class Until(StrEnum):
    """How far an execution continues after a pause."""

    BREAKPOINT = "breakpoint"
    MOMENT = "moment"
    """The next moment of any clause."""
    SAMPLE = "sample"
    """The next sample of the simulation."""
    CLOSED = "closed"
    """The end of the open windows of the clause that is the pause's subject; without a subject, the next moment."""


class Reason(StrEnum):
    """Why an execution has paused."""

    ENTRY = "entry"
    """The scenario is set up, and nothing has moved."""
    BREAKPOINT = "breakpoint"
    STEP = "step"
    PAUSE = "pause"


@dataclass(frozen=True, slots=True)
class ClauseBreakpoint:
    """Pauses at some moments of a clause: its feature line and, in a group, the number of its fluent (from 0)."""

    line: int
    part: int | None
    moments: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SetBreakpoints:
    """The order to replace all breakpoints. ``everywhere`` are the moments of any clause that pause the execution."""

    breakpoints: tuple[ClauseBreakpoint, ...] = ()
    everywhere: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Resume:
    """The order to continue after a pause, ``until`` a value of ``Until``."""

    until: str = Until.BREAKPOINT


@dataclass(frozen=True, slots=True)
class Pause:
    """The order to pause at the next sample."""


@dataclass(frozen=True, slots=True)
class WriteScene:
    """The order to write the execution so far, for drawing, as JSON to the file ``path``; valid during a pause."""

    path: str


DebugOrder = SetBreakpoints | Resume | Pause | WriteScene


@dataclass(frozen=True, slots=True)
class Hit:
    """A moment that has paused the execution, of fluent number ``part`` of the clause on feature line ``line``."""

    line: int
    part: int
    moment: str


@dataclass(frozen=True, slots=True)
class PartState:
    """A fluent of a clause, or the behaviour or event of a When clause.

    - ``iri``: the IRI of the fluent in the model; empty if the clause has no parts.
    - ``opened`` and ``closed``: the times of the first and the last sample of its window; ``None`` until known.
    - ``margin``: the margin now, or at the end of the window, in ``unit``; positive if the clause is satisfied.
    - ``decisive`` and ``decisive_at``: the deciding margin so far, and its time. This is the smallest margin or, if the
      predicate must hold only at ``some_time``, the largest.
    - ``note``: why there is no margin.
    """

    iri: str
    opened: float | None = None
    closed: float | None = None
    margin: float | None = None
    unit: str = ""
    decisive: float | None = None
    decisive_at: float | None = None
    some_time: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True)
class ClauseState:
    """A clause so far. ``verdict`` is empty until it is judged."""

    line: int
    verdict: str
    reason: str
    parts: tuple[PartState, ...]


@dataclass(frozen=True, slots=True)
class BodyState:
    """An object, or the tool of an agent."""

    name: str
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class AgentState:
    """An agent: the positions of its joints by name, and the objects that it grips."""

    name: str
    joints: tuple[tuple[str, float], ...]
    gripped: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RegionState:
    """A region of a workspace: its centre in the world, and half of its edge lengths (m)."""

    workspace: str
    carrier: str
    center: tuple[float, float, float]
    half: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class PastEvent:
    """An event that has occurred. ``iteration`` is as in ``monitor.trace.EventStamp``."""

    name: str
    time: float
    iteration: int


@dataclass(frozen=True, slots=True)
class Paused:
    """Scenario ``index`` has paused at ``time``.

    ``reason`` is a ``Reason``. ``line`` is the feature line of the clause that is the subject of the pause: the clause
    of the first hit, or else the clause whose step is executed; ``None`` before the first step. ``contacts`` are the
    pairs of elements that touch.
    """

    index: int
    time: float
    reason: str
    line: int | None
    hits: tuple[Hit, ...]
    clauses: tuple[ClauseState, ...]
    bodies: tuple[BodyState, ...]
    agents: tuple[AgentState, ...]
    regions: tuple[RegionState, ...]
    contacts: tuple[tuple[str, str], ...]
    events: tuple[PastEvent, ...]


@dataclass(frozen=True, slots=True)
class SceneWritten:
    """The answer to ``WriteScene``. ``problem`` is the reason if the file could not be written, otherwise empty."""

    index: int
    path: str
    problem: str = ""


_ORDERS: dict[str, type[DebugOrder]] = {kind.__name__: kind for kind in (SetBreakpoints, Resume, Pause, WriteScene)}


def encode_order(order: DebugOrder) -> str:
    """Return an order as one line of JSON in ASCII, without the line break."""
    return json.dumps({"type": type(order).__name__, **asdict(order)})


def decode_order(line: str) -> DebugOrder | None:
    """Return the order of a debugger that a line contains, or ``None`` if the line is another order.

    Raises ``ValueError`` if the order is invalid.
    """
    try:
        fields = json.loads(line)
        kind = _ORDERS.get(fields.pop("type"))
        return None if kind is None else from_plain(kind, fields)
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"not an order: {line[:200]!r}") from error
