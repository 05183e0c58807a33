"""What a run shows on terminals and elsewhere: a bar where one can be drawn, whole words, colours where wanted."""

from __future__ import annotations

import re
import subprocess
import sys
from functools import cache

import pytest

from commands.terminals import environment, on_a_terminal, screen_lines
from kit import EXAMPLES

pytestmark = pytest.mark.physics
MODEL = EXAMPLES / "pickplace" / "pickplace.bdd"
COMMAND = [sys.executable, "-m", "robbdd_tools.cli", "run", str(MODEL), "--first", "1", "--no-store"]
ESCAPE = "\x1b"
COLOUR = re.compile(r"\x1b\[[\d;]+m")


@cache
def on_terminal(columns: int, term: str = "xterm-256color", **variables: str) -> str:
    return on_a_terminal(COMMAND, columns, 0, TERM=term, **variables)


@cache
def elsewhere() -> str:
    done = subprocess.run(COMMAND, capture_output=True, encoding="utf-8", env=environment(), check=True)
    return done.stdout


def without_times(text: str) -> str:
    return re.sub(r"[\d.]+ s simulated in [\d.]+ s", "… simulated", text)


def test_elsewhere_there_are_plain_lines() -> None:
    written = elsewhere()
    assert ESCAPE not in written
    assert "\r" not in written
    assert "━" not in written
    assert all(line.strip() for line in written.splitlines())


def test_a_terminal_without_cursor_gets_the_same_plain_lines() -> None:
    assert without_times(on_terminal(60, "dumb")) == without_times(elsewhere())


def test_a_terminal_has_a_bar_and_colours_and_ends_with_a_line_of_its_own() -> None:
    written = on_terminal(160)
    assert COLOUR.search(written)
    assert "━" in written
    assert "0/1" in written
    last = written.splitlines()[-1]
    assert "1 scenario: 1 hold" in last


def test_colours_can_be_refused() -> None:
    written = on_terminal(160, NO_COLOR="1")
    assert "━" in written
    assert not COLOUR.search(written)


def test_a_narrow_terminal_breaks_lines_between_words() -> None:
    written = on_terminal(60)
    lines = screen_lines(written)
    assert max(map(len, lines)) <= 60
    shown, expected = (without_times(" ".join(text.split())) for text in (" ".join(lines), elsewhere()))
    assert sorted(shown.split()) == sorted(expected.split())
    margins = re.findall(r"[+−]\d+ mm$", elsewhere(), re.MULTILINE)
    assert margins
    assert re.findall(r"[+−]\d+ mm(?= *$)", "\n".join(lines), re.MULTILINE) == margins


def test_a_reason_that_several_clauses_share_is_told_once_below_them() -> None:
    command = [*COMMAND, "--timeout", "0.001"]
    lines = subprocess.run(command, capture_output=True, encoding="utf-8", env=environment()).stdout.splitlines()
    clauses = [line for line in lines if line.startswith("  ? ")]
    # The first clauses may be judged before the process ends; none may be lost.
    assert len(clauses) + sum(line.startswith(("  ✔ ", "  ✗ ")) for line in lines) == 5
    assert len(clauses) > 1
    assert lines[lines.index(clauses[-1]) + 1] == "      timed out after 0.001 s"
    assert sum("timed out" in line for line in lines) == 1


def test_a_bar_counts_unknown_scenarios_as_errored_as_editors_do() -> None:
    written = on_a_terminal([*COMMAND, "--timeout", "0.001"], 160, 1, TERM="xterm-256color", NO_COLOR="1")
    assert "0 hold, 0 failed, 1 errored" in written
