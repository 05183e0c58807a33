"""An execution pauses at the moments of its clauses, reports its state, and continues as if it had not."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from kit import schema_errors
from robbdd_tools.agent.channel import Channel, use_channel
from robbdd_tools.agent.clause_debugger import ClauseDebugger, Pauses, use_pauses
from robbdd_tools.agent.scenario_run import ScenarioRun
from robbdd_tools.agent.violation_states import ViolationStates
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.time import During
from robbdd_tools.protocol.clauses import Fluent
from robbdd_tools.protocol.messages import ClauseJudged, RunMessage, decode, encode
from robbdd_tools.protocol.pauses import (
    ClauseBreakpoint,
    DebugOrder,
    Moment,
    Pause,
    Paused,
    Resume,
    SetBreakpoints,
    Until,
    WriteScene,
    encode_order,
)
from robbdd_tools.protocol.specs import ClauseSpec
from world.worlds import BIN_WS, CUBE, EVENTS, PANDA, scenario

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray

pytestmark = pytest.mark.physics
EVERY = SetBreakpoints((), tuple(Moment))
STEPS = (
    (5, "given", f'"{CUBE}" is located at "env:bench_ws" before event "t:pick-start"'),
    (6, "when", f'"{PANDA}" picks "{CUBE}" and places it at "{BIN_WS}"'),
    (7, "then", f'"{PANDA}" moves slower than "0.2 m/s" from "t:pick-start" until "t:pick-end"'),
    (8, "then", f'not ( "{CUBE}" is held by "{PANDA}" after event "t:pick-end" )'),
    # Its window never closes: what is measured for a pause must not appear in the trace.
    (9, "then", f'"{PANDA}" can reach "{CUBE}" from "t:place-end" until "t:never"'),
)
Answer = Callable[[Paused], Sequence[DebugOrder]]


class Debugged(Channel):
    """Keeps the messages of a scenario, and answers each pause."""

    def __init__(self, answer: Answer | None) -> None:
        self.messages: list[RunMessage] = []
        self.answer = answer
        self.debugger = ClauseDebugger()

    def send(self, message: RunMessage) -> None:
        assert decode(encode(message)) == message
        self.messages.append(message)
        if isinstance(message, Paused):
            assert self.answer is not None
            for order in self.answer(message):
                assert self.debugger.take(encode_order(order))

    @property
    def pauses(self) -> list[Paused]:
        """The pauses, without that at the beginning."""
        return [message for message in self.messages if isinstance(message, Paused)][1:]

    @property
    def verdicts(self) -> list[ClauseJudged]:
        return [message for message in self.messages if isinstance(message, ClauseJudged)]


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    yield
    use_channel(Channel())
    use_pauses(Pauses())


def execute(
    folder: Path,
    answer: Answer | None,
    steps: Sequence[tuple[int, str, str]] = STEPS,
    statements: Mapping[int, Fluent] | None = None,
) -> Debugged:
    """Execute a scenario as behave does, and keep its trace in a folder."""
    found = Debugged(answer)
    use_channel(found)
    use_pauses(Pauses() if answer is None else found.debugger)
    stated = statements or {}
    named = (
        (line, f"https://example.org/{line}", f"c{line}", role, text, stated.get(line)) for line, role, text in steps
    )
    clauses = tuple(ClauseSpec(*one) for one in named)
    spec = scenario(clauses=clauses, events={**EVENTS, "t:never": "never"})
    run = ScenarioRun(0, spec, steps, found, ViolationStates(folder), keep=folder)
    for line, role, text in steps:
        (run.behaviour if role == "when" else run.clause)(line, text)
    run.finish()
    return found


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for part in ("traces", "margins") for path in (folder / part).iterdir()}


@pytest.fixture(scope="module")
def paused(tmp_path_factory: pytest.TempPathFactory) -> tuple[Debugged, dict[str, bytes]]:
    """A scenario that has paused at every moment of every clause, and the files that it left."""
    folder = tmp_path_factory.mktemp("paused")
    (folder / "traces").mkdir()
    found = execute(folder, lambda _: (EVERY, WriteScene(str(folder / "scene.json")), Resume()))
    return found, files(folder)


def test_pauses_change_neither_verdicts_nor_the_trace(
    paused: tuple[Debugged, dict[str, bytes]], tmp_path: Path
) -> None:
    (tmp_path / "traces").mkdir()
    plain = execute(tmp_path, None)
    assert plain.verdicts == paused[0].verdicts
    assert files(tmp_path) == paused[1]
    assert set(files(tmp_path)) == {"000000.mcap", "000000.json"}


def test_each_moment_pauses_once_at_its_sample(paused: tuple[Debugged, dict[str, bytes]]) -> None:
    found = [[(hit.line, hit.moment) for hit in pause.hits] for pause in paused[0].pauses]
    assert found == [
        [(5, "opens"), (5, "closes"), (7, "opens"), (6, "opens")],
        [(7, "turns negative")],
        [(7, "closes"), (8, "opens"), (8, "turns negative"), (8, "closes")],
        [(9, "opens"), (6, "closes")],
    ]
    times = {event.name: event.time for event in paused[0].pauses[-1].events}
    at = [pause.time for pause in paused[0].pauses]
    assert [at[0], at[2], at[3]] == [times["t:pick-start"], times["t:pick-end"], times["t:place-end"]]
    violated = next(one for one in paused[0].verdicts if one.line == 7)
    assert at[1] == pytest.approx(violated.at)


def test_a_pause_reports_margins_poses_and_events(paused: tuple[Debugged, dict[str, bytes]]) -> None:
    speeding = paused[0].pauses[1]
    (part,) = next(clause.parts for clause in speeding.clauses if clause.line == 7)
    assert (part.opened, part.closed, part.unit) == (paused[0].pauses[0].time, None, "m/s")
    assert part.margin is not None
    assert part.margin < 0
    assert (part.decisive, part.decisive_at) == (part.margin, speeding.time)
    given = next(clause for clause in speeding.clauses if clause.line == 5)
    assert given.verdict == "holds"
    assert speeding.line == 7
    at_pick = paused[0].pauses[2]
    held = next(agent for agent in at_pick.agents if agent.name == PANDA)
    assert held.gripped == (CUBE,)
    assert len(held.joints) == 7
    assert ("env:cube1", "env:panda") in at_pick.contacts
    cube, tool = (next(body for body in at_pick.bodies if body.name == name) for name in (CUBE, PANDA))
    assert cube.position == pytest.approx(tool.position, abs=0.05)
    region = next(region for region in at_pick.regions if region.workspace == BIN_WS)
    assert region.carrier == "env:bin1"
    assert [event.name for event in at_pick.events] == ["t:start", "t:pick-start", "t:pick-end", "t:place-start"]


def test_the_scene_of_a_pause_ends_at_its_sample(tmp_path: Path) -> None:
    def answer(pause: Paused) -> Sequence[DebugOrder]:
        if pause.reason == "entry":
            return SetBreakpoints((), ("turns negative",)), Resume()
        return WriteScene(str(tmp_path / "scene.json")), Resume()

    found = execute(tmp_path, answer, STEPS[:3])
    scene: dict[str, Any] = json.loads((tmp_path / "scene.json").read_text(encoding="utf-8"))
    (pause,) = found.pauses
    assert scene["duration"] == pause.time
    assert scene["parts"]["7"][0]["end"] == pytest.approx(pause.time)
    head: dict[str, Any] = {"run": 1, "folder": "file:///x", "source": None, "clauses": []}
    shown = {"index": 0, "name": "n", "values": "", "story": "s", "variant": "v", "variation": 1, "execution": None}
    shown |= {"repetition": 1, "seed": 1, "verdict": "unknown", "trace": True}
    document = {name: value for name, value in scene.items() if name != "parts"}
    assert schema_errors("trace.schema.json", {**head, "scenario": shown, **document}) == []


def test_steps_go_to_the_next_sample_the_next_moment_and_the_end_of_open_windows(tmp_path: Path) -> None:
    orders = iter([Until.MOMENT, Until.SAMPLE, Until.SAMPLE, Until.MOMENT, Until.CLOSED, Until.BREAKPOINT])
    found = execute(tmp_path, lambda _: (Resume(next(orders)),), STEPS[:3])
    reasons = [(pause.reason, [hit.moment for hit in pause.hits if hit.line == 7]) for pause in found.pauses]
    assert {reason for reason, _ in reasons} == {"step"}
    assert [moments for _, moments in reasons] == [["opens"], [], [], ["turns negative"], ["closes"]]
    first, second, third, *_ = (pause.time for pause in found.pauses)
    assert (second - first, third - second) == pytest.approx((0.016, 0.016))


def test_a_breakpoint_is_on_a_clause_and_on_some_of_its_moments(tmp_path: Path) -> None:
    own = SetBreakpoints((ClauseBreakpoint(7, 0, ("closes",)), ClauseBreakpoint(5, 3, ("opens",))))
    found = execute(tmp_path, lambda _: (own, Resume()), STEPS[:3])
    assert [[(hit.line, hit.moment) for hit in pause.hits] for pause in found.pauses] == [[(7, "closes")]]


def test_an_order_to_pause_is_obeyed_at_the_next_sample(tmp_path: Path) -> None:
    orders = iter([(Pause(), Resume()), (Resume(),)])
    found = execute(tmp_path, lambda _: next(orders), STEPS[:3])
    assert [(pause.reason, pause.time, pause.line) for pause in found.pauses] == [("pause", 0.0, 5)]


def test_users_code_is_called_only_to_judge(tmp_path: Path) -> None:
    """It may have effects: its margin is unknown until its clause is judged."""
    calls: list[int] = []

    def margins(evidence: Evidence, _arguments: Arguments) -> FloatArray:
        calls.append(len(evidence.times))
        return -abs(evidence.times)

    users = replace(load_catalog().predicates["moves-slower-than"], evaluate=margins)
    clause = Fluent(users, {"agent": PANDA, "limit": "0.2 m/s"}, During("t:pick-start", "t:pick-end"))
    seen: list[int] = []

    def answer(_: Paused) -> Sequence[DebugOrder]:
        seen.append(len(calls))
        return EVERY, Resume()

    found = execute(tmp_path, answer, STEPS[:3], {7: clause})
    moments = [hit.moment for pause in found.pauses for hit in pause.hits if hit.line == 7]
    assert moments == ["opens", "closes", "turns negative"]
    assert seen[:3] == [0, 0, 0]
    note = next(clause.parts[0].note for clause in found.pauses[0].clauses if clause.line == 7)
    assert note == "Python code judges it, when its window has closed"
