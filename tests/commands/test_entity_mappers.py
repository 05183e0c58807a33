"""Entity mappers in Python say which frame of a log is which element."""

from __future__ import annotations

from pathlib import Path

import pytest

from logs.bags import Message, poses, write
from logs.drives import clauses, drive, robbdd
from logs.named_drive import cell, named

pytestmark = pytest.mark.physics
OBSERVED = """obs provider (ns=exec) camera {{ ros topic: "{topic}" type: "geometry_msgs/msg/PoseArray" }}
observation (ns=exec) things {{
    provider: <camera>
    observes var <pick-place.thing>
    entity mapper: py {{ module: mapping, attr: {mapper} }}
}}
obs policy (ns=exec) seen for <pick-place.at-source> {{ trinary topic: "/seen" }}
obs policy (ns=exec) near for <pick-place.in-hand> {{
    observations: {{ <things> }}
    evaluator: linear distance {{ less-than: 0.2 m }}
}}
"""
MAPPING = """def by_index(frame):
    return {"blocks/1": "cube0"}.get(frame)

def every(frame):
    return "cube0"

def wrong(frame):
    return "cube_0"

def number(frame):
    return 0

def broken(frame):
    return frame[1000]
"""


def blocks() -> list[Message]:
    """A drive whose cube is the second pose on a topic; the first one is a thing that never moves."""
    found = drive(cube="unseen")
    stays, begin, end = (0.2, 0.2, 0.825), (0.45, 0.0, 0.825), (0.55, 0.3, 0.86)
    for tick in range(101):
        time = tick / 10
        share = min(max((time - 3.0) / 4.0, 0.0), 1.0)
        place = [one + share * (other - one) for one, other in zip(begin, end, strict=True)]
        found.append(poses("/blocks", [stays, place], stamp=time))
    return found


def judged(folder: Path, mapper: str, *more: str, topic: str = "/blocks") -> tuple[dict[str, str], str, int]:
    """Judge the drive with a mapper; return the verdict and the reason of its goal, the remarks and the exit code."""
    observed = OBSERVED.format(mapper=mapper, topic=topic)
    text_of = named(path="blocks").replace("robot log", observed + "robot log", 1)
    path = cell(folder, text_of.replace("log: <monday>", "policies: { <near> } log: <monday>"))
    write(path.with_name("blocks"), blocks())
    path.with_name("mapping.py").write_text(MAPPING, encoding="utf-8")
    out = folder / "out.json"
    done = robbdd(path.parent, "judge", "real.bddx", "--no-store", "--json", str(out), *more)
    if not out.is_file():
        return {}, done.stderr, done.returncode
    (goal,) = (one for one in clauses(out) if one["name"].endswith("at-goal"))
    return {"verdict": goal["verdict"], "reason": goal["reason"]}, done.stderr, done.returncode


def test_the_frame_that_a_mapper_names_is_the_element(tmp_path: Path) -> None:
    goal, _, _ = judged(tmp_path, "by_index")
    assert goal["verdict"] == "holds"


def test_a_mapper_is_only_asked_about_the_frames_of_its_provider(tmp_path: Path) -> None:
    goal, remarks, _ = judged(tmp_path, "every", topic="/seen_by_another_camera")
    assert goal["verdict"] == "unknown"
    assert "the log has no frame for env:cube0" in remarks


@pytest.mark.parametrize(
    ("mapper", "words"),
    [
        ("every", "mapping:every returned 'cube0' for two frames, 'blocks/0' and 'blocks/1'"),
        ("wrong", "mapping:wrong returned 'cube_0' for the frame 'blocks/0': return None or an element: "),
        ("number", "mapping:number returned 0 for the frame 'blocks/0': return None or an element: "),
        ("broken", "mapping:broken failed: IndexError: string index out of range"),
        ("absent", "the Python module mapping has no function 'absent'"),
    ],
)
def test_a_wrong_answer_leaves_the_clauses_unknown_with_the_reason(mapper: str, words: str, tmp_path: Path) -> None:
    goal, _, code = judged(tmp_path, mapper)
    assert (goal["verdict"], code) == ("unknown", 1)
    assert words in goal["reason"]


def test_no_user_code_refuses_a_mapper_and_names_it(tmp_path: Path) -> None:
    goal, message, code = judged(tmp_path, "by_index", "--no-user-code")
    assert (goal, code) == ({}, 2)
    assert "the Python code mapping:by_index maps the frames of the log" in message
