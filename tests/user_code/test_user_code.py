"""What users' code does wrong is described as data: type, message, frames in the user's files, origin, place."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from judging.judged_policies import judged, moving, spec_of
from robbdd_tools.agent.channel import Reports
from robbdd_tools.agent.printed_output import CUT, MAX_CHARACTERS, Printed
from robbdd_tools.agent.tree_execution import TreeRun
from robbdd_tools.catalog.coordination import NodeSpec, TreeSpec
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.policy import Rule
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import Output, ScenarioFinished, ScenarioStarted, decode
from robbdd_tools.user_code.calls import MAX_FRAMES, UserCodeError, call_user_code, fault_of
from robbdd_tools.world.errors import SceneError, UserError
from robbdd_tools.world.user_behaviour import AgentWorld, run_user_behaviour

numbers = count()
BEHAVIOUR = """
class Own:
    def __init__(self):
        pass

    def reset(self, world, behaviour, arguments):
        self.left = 2

    def step(self):
        self.left -= 1
        return not self.left
"""


class Stub:
    time = 0.25

    def watched(self, name: str, code: Callable[..., Any], *arguments: Any) -> Any:
        return call_user_code(name, code, *arguments)


def module(folder: Path, code: str) -> str:
    name = f"user_code_{next(numbers)}"
    (folder / f"{name}.py").write_text(code, encoding="utf-8")
    return name


def behave(folder: Path, code: str, attribute: str = "Own") -> Fault:
    """The fault of a behaviour, which has to be one."""
    origin = Origin(str(folder / "run.bddx"), 5, 3)
    own = Implementation("https://x/own", "python", f"{module(folder, code)}:{attribute}", origin)
    with pytest.raises(UserError) as caught:
        list(run_user_behaviour(own, cast(AgentWorld, Stub()), "pick", {"object": "a"}))
    assert caught.value.fault is not None
    assert caught.value.fault.origin == "https://x/own"
    assert str(caught.value).startswith("run.bddx:5:3: ")
    return caught.value.fault


def where(fault: Fault) -> tuple[str, int, str] | None:
    place = fault.place
    return None if place is None else (Path(place.file).stem.rpartition("_")[0], place.line, place.function)


@pytest.mark.parametrize(
    ("old", "new", "exception", "message", "place"),
    [
        ("self.left = 2", 'arguments["goal"]', "KeyError", "'goal'", (7, "reset")),
        ("        pass", "        1 / 0", "ZeroDivisionError", "division by zero", (4, "__init__")),
        ("return not self.left", 'return "done"', "", "must return True or False, not 'done'", (9, "step")),
        ("(self, world, behaviour, arguments)", "(self, world)", "TypeError", "takes 2 positional", (6, "reset")),
        ("self.left -= 1", "raise SystemExit(3)", "SystemExit", "3", (10, "step")),
        ("self.left = 2", 'raise ValueError("half \\udc80")', "ValueError", "half \\udc80", (7, "reset")),
        ("\nclass Own:", "\nclass Own", "SyntaxError", "expected ':'", (2, "")),
        ("\nclass Own:", "import no_such_module\nclass Own:", "ModuleNotFoundError", "no_such_module", (1, "<module>")),
        ("class Own:", "class Other:", "", "has no function 'Own'", (1, "")),
    ],
)
def test_an_error_of_a_behaviour_has_its_type_message_and_place(
    tmp_path: Path, old: str, new: str, exception: str, message: str, place: tuple[int, str]
) -> None:
    assert old in BEHAVIOUR
    fault = behave(tmp_path, BEHAVIOUR.replace(old, new))
    assert fault.exception == exception
    assert message in fault.message
    assert where(fault) == ("user_code", *place)
    assert fault.digest


def test_a_behaviour_that_returns_nothing_or_a_truth_value_of_numpy_goes_on(tmp_path: Path) -> None:
    code = "import numpy as np\n" + BEHAVIOUR.replace(
        "return not self.left", "return np.True_ if not self.left else None"
    )
    own = Implementation("https://x/own", "python", f"{module(tmp_path, code)}:Own", Origin(str(tmp_path / "m"), 1, 1))
    assert len(list(run_user_behaviour(own, cast(AgentWorld, Stub()), "pick", {}))) == 1


def test_frames_of_libraries_are_told_apart_and_ours_are_left_out(tmp_path: Path) -> None:
    code = BEHAVIOUR.replace("self.left = 2", "import json; json.loads('{')")
    fault = behave(tmp_path, code)
    assert [frame.own for frame in fault.frames][:2] == [True, False]
    assert where(fault) == ("user_code", 7, "reset")
    assert not any("robbdd_tools" in frame.file for frame in fault.frames)
    shown = list(fault.traceback())
    assert shown[0].endswith(", line 7, in reset")
    assert shown[1] == "    import json; json.loads('{')"
    assert shown[-1].startswith("JSONDecodeError: ")


def test_a_deep_recursion_keeps_its_ends(tmp_path: Path) -> None:
    fault = behave(tmp_path, BEHAVIOUR.replace("self.left = 2", "self.reset(world, behaviour, arguments)"))
    assert fault.exception == "RecursionError"
    assert len(fault.frames) == MAX_FRAMES


def test_the_same_error_with_other_values_has_the_same_id(tmp_path: Path) -> None:
    name = module(
        tmp_path, "def look(table, key):\n    return table[key]\n\ndef other(table, key):\n    return table[key]\n"
    )
    sys.path.append(str(tmp_path))
    try:
        code = __import__(name)
    finally:
        sys.path.remove(str(tmp_path))

    def fault(function: Any, key: str) -> Fault:
        with pytest.raises(UserCodeError) as caught:
            call_user_code("code", function, {}, key)
        return caught.value.fault

    assert fault(code.look, "a").id == fault(code.look, "b").id != fault(code.other, "a").id


@pytest.mark.parametrize(
    ("body", "exception", "message", "line"),
    [
        ("return evidence.nothing", "AttributeError", "nothing", 2),
        ("return float('nan')", "", "must return finite numbers, but 1 are not", 1),
        ("return 'yes'", "", "must return one number or truth value", 1),
        ("return {}['key']", "KeyError", "'key'", 2),
    ],
)
def test_an_error_of_a_policy_makes_its_clause_unknown(
    tmp_path: Path, body: str, exception: str, message: str, line: int
) -> None:
    name = module(tmp_path, f"def own(evidence, arguments):\n    {body}\n")
    verdict = judged(spec_of(Rule("python", f"{name}:own"), model=str(tmp_path / "m.bddx")), moving([0.2, 0.3]))
    assert verdict.outcome is Outcome.UNKNOWN
    fault = verdict.fault
    assert fault is not None
    assert (fault.exception, fault.origin) == (exception, "x:policy")
    assert message in fault.message
    assert where(fault) == ("user_code", line, "own")
    assert message in verdict.reason


@pytest.mark.parametrize(
    ("body", "exception", "line"), [("return leaf('nobody')", "ValueError", 2), ("return 7", "", 1)]
)
def test_an_error_of_a_trees_code_belongs_to_the_tree(tmp_path: Path, body: str, exception: str, line: int) -> None:
    name = module(tmp_path, f"def tree(leaf):\n    {body}\n")
    source = Implementation("https://x/tree", "python", f"{name}:tree", Origin(str(tmp_path / "m.bdd"), 2, 1))
    spec = TreeSpec("t 1", "https://x/tree", (NodeSpec("https://x/n", "n", "leaf"),), 0.5, 0.0, source)

    def nothing(*_: object) -> Any:
        raise AssertionError

    with pytest.raises(SceneError) as caught:
        TreeRun(spec, nothing, nothing)
    fault = caught.value.fault
    assert fault is not None
    assert (fault.exception, fault.origin) == (exception, "https://x/tree")
    assert where(fault) == ("user_code", line, "tree")


def test_an_error_of_an_evaluator_that_a_package_brings_is_described_too() -> None:
    with pytest.raises(ValueError, match="reshape") as caught:
        np.zeros(2).reshape(3)
    fault = fault_of(caught.value, "is warm")
    assert fault.place is not None
    assert fault.place.file == __file__


@pytest.fixture
def pipe() -> tuple[Reports, Any]:
    source, sink = os.pipe()
    channel = Reports(sink)

    def read() -> list[Any]:
        os.close(sink)
        with os.fdopen(source, encoding="utf-8") as lines:
            return [message for line in lines if isinstance(message := decode(line), Output)]

    return channel, read


def test_what_is_printed_is_passed_on_line_by_line_and_logged(pipe: tuple[Reports, Any]) -> None:
    channel, read = pipe
    log = io.StringIO()
    stream = Printed(channel, log)
    print("loading", file=stream)
    channel.send(ScenarioStarted(4))
    print("one\ntwo", file=stream)
    print("without end", end="", file=stream)
    stream.finish()
    channel.send(ScenarioFinished(4, 0.0, 0.0, 0.0))
    assert read() == [Output(None, "loading"), *(Output(4, line) for line in ("one", "two", "without end"))]
    assert log.getvalue() == "loading\none\ntwo\nwithout end"


def test_of_much_that_is_printed_the_beginning_is_passed_on_and_the_next_scenario_has_its_own_share(
    pipe: tuple[Reports, Any],
) -> None:
    channel, read = pipe
    log = io.StringIO()
    stream = Printed(channel, log)
    for index in (0, 1):
        channel.send(ScenarioStarted(index))
        for _ in range(MAX_CHARACTERS // 10):
            print("x" * 99, file=stream)
        stream.finish()
        channel.send(ScenarioFinished(index, 0.0, 0.0, 0.0))
    found = read()
    assert len(log.getvalue()) == 2 * 100 * (MAX_CHARACTERS // 10)
    for index in (0, 1):
        text = "\n".join(message.text for message in found if message.index == index)
        assert text.endswith(CUT)
        assert text.count(CUT) == 1
        assert len(text) < MAX_CHARACTERS + 1000
