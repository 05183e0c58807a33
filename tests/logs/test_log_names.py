"""Which frame an element is, and when a log reports an event."""

from __future__ import annotations

from dataclasses import replace

import pytest

from judging.judged_policies import spec_of
from robbdd_tools.logs.log_contents import TextStamp
from robbdd_tools.logs.log_names import (
    FramesProblem,
    frame_of,
    occurrences_of,
    shared_frames,
    stated_frames,
    tool_frame_of,
)
from robbdd_tools.monitor.policy import Observation, Policy
from world.worlds import CUBE

FRAMES = ("map", "cup_1", "left/cup-2", "right/cup2", "Bin")


@pytest.mark.parametrize(
    ("element", "frame"),
    [("env:bin", "Bin"), ("env:cup1", "cup_1"), ("env:parts/cup1", "cup_1"), ("env:CUP_1", "cup_1")],
)
def test_a_frame_is_found_by_the_name_of_the_element(element: str, frame: str) -> None:
    assert frame_of(element, FRAMES, {}) == frame


@pytest.mark.parametrize("stated", [{"env:cup1": "right/cup2"}, {"cup1": "/right/cup2"}])
def test_a_stated_frame_comes_first(stated: dict[str, str]) -> None:
    assert frame_of("env:cup1", FRAMES, stated) == "right/cup2"


@pytest.mark.parametrize(
    ("element", "stated", "words"),
    [
        ("env:cup2", {}, "several frames fit env:cup2: left/cup-2, right/cup2; choose with --frame cup2=FRAME"),
        ("env:cup_3", {}, "the log has no frame for env:cup_3; nearest: cup_1"),
        ("env:screw", {}, "name it with --frame screw=FRAME"),
        ("env:bin", {"bin": "bn"}, "the log has no frame 'bn' for env:bin"),
    ],
)
def test_what_is_missing_is_named_with_what_there_is(element: str, stated: dict[str, str], words: str) -> None:
    with pytest.raises(FramesProblem) as caught:
        frame_of(element, FRAMES, stated)
    assert words in str(caught.value)


def test_a_log_without_frames_is_reported_and_long_lists_are_cut() -> None:
    def problem(frames: tuple[str, ...]) -> str:
        with pytest.raises(FramesProblem) as caught:
            frame_of("env:screw", frames, {})
        return str(caught.value)

    begin, end = "the log has no frame for env:screw", "; name it with --frame screw=FRAME"
    assert problem(()) == f"{begin}: it has no frames{end}"
    assert problem(tuple("klmnopqji")) == f"{begin}; it has: i, j, k, l, m, n, o, p{end}"
    assert problem(("scrow", "abc", "scrw")) == f"{begin}; nearest: scrw, scrow{end}"


@pytest.mark.parametrize(
    "text", ["ex:evt-pick-end", "pick_ended", "PickEnd", " E_PICK_END ", "evt-pick-end", "grasped"]
)
def test_a_text_reports_an_event_by_its_name_or_its_emitters(text: str) -> None:
    texts = [TextStamp("/events", text, 2.0), TextStamp("/events", "pick-start", 1.0), TextStamp("/log", text, 3.0)]
    assert [one.time for one in occurrences_of("ex:grasped", "pick-end", texts)] == [2.0, 3.0]


def test_a_longer_text_reports_nothing() -> None:
    lines = (
        "waiting for pick-end",
        "",
        "waiting for: pick-end",
        "ERROR: pick-end",
        "next/state: pick-end",
        "a b/pick-end",
    )
    texts = [TextStamp("/log", line, float(time)) for time, line in enumerate(lines)]
    assert occurrences_of("ex:evt-pick-end", "pick-end", texts) == []


def test_the_observations_of_policies_state_frames_of_variables_and_elements() -> None:
    spec = spec_of()
    assert spec.execution is not None
    (policy,) = spec.execution.policies
    seen: Observation = policy.observations[0]
    mapped = replace(seen, mapped=(("cube_frame", "t:var-thing"), ("bin_frame", "env:bin")))
    observing: Policy = replace(policy, observations=(seen, mapped))
    spec = replace(spec, execution=replace(spec.execution, policies=(observing,)))
    assert stated_frames(spec) == {CUBE: "cube_frame", "env:bin": "bin_frame"}
    assert stated_frames(replace(spec, execution=None)) == {}


@pytest.mark.parametrize("base", ["panda/base_link", "panda/odom", "panda/panda_link0", "panda/base"])
def test_a_base_is_no_tool_unless_it_is_stated(base: str) -> None:
    with pytest.raises(FramesProblem) as caught:
        tool_frame_of("env:panda", ["map", base], {})
    words = f"'{base}' is the base of env:panda, and no frame has the name of its tool"
    assert str(caught.value) == f"{words}; name the frame of the tool with --frame panda=FRAME"
    assert tool_frame_of("env:panda", ["map", base], {"panda": base}) == base
    assert tool_frame_of("env:panda", ["map", base], {"env:panda": base}) == base
    assert tool_frame_of("env:panda", ["map", base, "panda"], {}) == "panda"
    assert tool_frame_of("env:panda", ["map", "panda/tool0"], {}) == "panda/tool0"


@pytest.mark.parametrize(
    "planned", ["goal/cup1", "cup1/goal_pose", "arm/target/cup-1", "desired_poses/cup_1", "cup1/cmd"]
)
def test_a_place_that_is_planned_is_not_where_a_thing_is(planned: str) -> None:
    with pytest.raises(FramesProblem) as caught:
        frame_of("env:cup1", ["map", planned], {})
    words = f"'{planned}' may be where env:cup1 is meant to be, not where it is, so it is not used"
    assert str(caught.value) == f"{words}; if it was measured, name it with --frame cup1=FRAME"
    assert frame_of("env:cup1", ["map", planned, "camera/cup1"], {}) == "camera/cup1"
    assert frame_of("env:cup1", ["map", planned], {"cup1": planned}) == planned


def test_a_thing_may_be_called_by_such_a_word() -> None:
    assert frame_of("env:target_bin", ["map", "cell/target_bin", "goal/target_bin"], {}) == "cell/target_bin"
    assert frame_of("env:goal", ["map", "goal"], {}) == "goal"


def test_where_the_user_declares_an_event_other_texts_do_not_report_it() -> None:
    texts = [TextStamp("/state", "PICK_END", 2.0), TextStamp("/done", "pick-end", 4.0, declared=True)]
    assert [one.time for one in occurrences_of("ex:evt-pick-end", "pick-end", texts)] == [4.0]
    assert [one.time for one in occurrences_of("ex:evt-pick-end", "pick-end", texts[:1])] == [2.0]
    assert occurrences_of("ex:evt-pick-end", "pick-end", texts[:1], ["evt-pick-end"]) == []
    assert [one.time for one in occurrences_of("ex:evt-pick-end", "pick-end", texts[:1], ["place-end"])] == [2.0]


def test_a_frame_belongs_to_the_element_of_its_name_and_to_those_for_which_it_is_stated() -> None:
    one = {"ex:cube1": "cube1", "ex:cube-1": "cube1", "ex:bin": "bin"}
    words = "the frame 'cube1' fits ex:cube-1, but also ex:cube1; name that of ex:cube-1 with --frame ex:cube-1=FRAME"
    assert shared_frames(one, {}) == {"ex:cube-1": words}
    assert shared_frames(one, {"cube-1": "cube1"}) == {}
    assert shared_frames(one, {"ex:cube1": "cube1", "cube-1": "cube1"}) == {}
    assert set(shared_frames({"a:cube": "cell/cube", "b:cube": "cell/cube"}, {})) == {"a:cube", "b:cube"}
