"""The tutorial is executed as it is written: its files, its edits and its commands, with the output that it shows."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from fork_kit import ROBBDD
from kit import DOCS
from robbdd_tools.commands import FAILED

PAGE = DOCS / "tutorial.md"
BLOCK = re.compile(r"(?:^`(?P<file>[\w/.]+)`:\n\n)?^```(?P<kind>robbdd|diff|console)\n(?P<text>.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"\d+(?:\.\d+)?")
WALL_TIME = re.compile(r"simulated in [\d.]+ s")
REAL = (sys.executable, "-m", "robbdd_tools")
"""What renders is no fork: a fork has loaded the engine without graphics."""
OWN_FILES = frozenset({"ur5.urdf"})
"""Files of a reader, which no page contains."""
TOLERANCE = 0.05
"""Numbers may differ by this part, since processors round differently."""


def edited(text: str, change: str) -> str:
    """Return a text after a change in the format of ``diff``, without line numbers."""
    lines = change.splitlines(keepends=True)
    old = "".join(line[1:] for line in lines if line[0] in " -")
    assert text.count(old) == 1, change
    return text.replace(old, "".join(line[1:] for line in lines if line[0] in " +"))


def commands(text: str) -> Iterator[tuple[list[str], list[str]]]:
    """Yield each command of a console with the lines that it should print."""
    for part in re.split(r"^\$ ", text, flags=re.M)[1:]:
        command, *shown = part.splitlines()
        yield shlex.split(command), shown


def matches(shown: Sequence[str], printed: Sequence[str]) -> bool:
    """Return whether the lines that are shown are those printed; ``…`` stands for any lines."""
    if not shown:
        return not printed
    if shown[0] == "…":
        return any(matches(shown[1:], printed[start:]) for start in range(len(printed) + 1))
    return bool(printed) and same(shown[0], printed[0]) and matches(shown[1:], printed[1:])


def same(shown: str, printed: str) -> bool:
    one, other = (WALL_TIME.sub("", text).split() for text in (shown, printed))
    if [NUMBER.sub("", word) for word in one] != [NUMBER.sub("", word) for word in other]:
        return False
    pairs = zip(NUMBER.findall(" ".join(one)), NUMBER.findall(" ".join(other)), strict=True)
    return all(float(a) == pytest.approx(float(b), rel=TOLERANCE, abs=1e-4) for a, b in pairs)


def follow(page: Path, folder: Path) -> set[str]:
    """Write, edit and execute what a page says, and return the commands that it executed."""
    executed: set[str] = set()
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        path, text = folder / (block["file"] or "."), block["text"]
        if block["kind"] == "robbdd":
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        elif block["kind"] == "diff":
            path.write_text(edited(path.read_text(encoding="utf-8"), text), encoding="utf-8")
        else:
            for (program, *arguments), shown in commands(text):
                assert program == "robbdd"
                if OWN_FILES & {*arguments}:
                    continue
                started = REAL if arguments[0] == "view" else ROBBDD
                done = subprocess.run([*started, *arguments], cwd=folder, capture_output=True, text=True)
                assert done.returncode < FAILED, (arguments, done.stderr)
                assert matches(shown, done.stdout.splitlines()), (arguments, done.stdout, done.stderr)
                executed.add(arguments[0])
    return executed


@pytest.mark.physics
@pytest.mark.usefixtures("forks")
def test_the_tutorial_and_the_page_of_an_own_arm_do_what_they_say(tmp_path: Path) -> None:
    assert follow(PAGE, tmp_path) == {"check", "run", "report", "judge"}
    shutil.copy(DOCS / "robots" / "rhea.urdf", tmp_path / "cell")
    assert follow(DOCS / "robots.md", tmp_path) == {"view", "check", "run"}


def test_a_line_with_another_verdict_or_number_is_noticed() -> None:
    line = "  ✔ cube is located at tray_ws after place-ends +16 mm"
    assert same(line, line.replace(" +16", "    +16"))
    assert not same(line, line.replace("✔", "✗"))
    assert not same(line, line.replace("16", "18"))
    assert matches(["…", line], ["any", line])
    assert not matches([line], [line, "more"])
