"""Render pictures of a run folder in a separate process, with the first graphics back end that works."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from robbdd_tools.base.graphics import CHOICE, NO_GRAPHICS, back_ends, nothing_renders
from robbdd_tools.base.interpreter import run

MOMENTS, VIDEOS, THUMBNAILS = "moments", "videos", "thumbnails"


class NoPictures(Exception):
    """Pictures cannot be rendered; the message gives the reason and what to do."""


def no_display() -> str:
    """Return why no window can be opened here; empty if one can."""
    if sys.platform != "linux" or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        return ""
    return "--viewer needs a display, and there is none (DISPLAY is not set); --record DIR writes videos"


def render_scene(folder: Path, index: int, output: Path) -> None:
    """Render the initial scene of scenario number ``index`` of a run folder; raises ``NoPictures``."""
    _render(folder, str(index), output)


def render_violations(folder: Path, output: Path) -> int:
    """Render the moment of every violated clause into a folder; return the number of pictures.

    Raises ``NoPictures``.
    """
    return len(_render(folder, MOMENTS, output))


def render_videos(folder: Path, output: Path) -> int:
    """Render a video of every scenario of a run into a folder; return the number of videos. Raises ``NoPictures``."""
    return len(_render(folder, VIDEOS, output))


def render_thumbnails(folder: Path, output: Path, chosen: Iterable[tuple[int, int]]) -> int:
    """Render thumbnails of the moments at which some clauses are violated. Raises ``NoPictures``.

    ``chosen`` identifies each clause by the number of its scenario and its feature line.
    """
    return len(_render(folder, THUMBNAILS, output, [f"{index}:{line}" for index, line in chosen]))


def render_robot(arm: str, output: Path, mounted: Sequence[str] = ()) -> tuple[list[str], str]:
    """Render one arm alone. Return the lines of its report, and why there is no picture (empty if there is one).

    ``arm`` is the path of an MJCF or URDF file or a name of the catalog. ``mounted`` is the path of a gripper's file
    and the body or site of the arm that carries it. Raises ``NoPictures`` if the arm cannot be used.
    """
    tried: list[str] = []
    for back_end in back_ends():
        done = run("robbdd_tools.agent.show_robot", arm, str(output.absolute()), *mounted, more={CHOICE: back_end})
        if done.returncode == 0:
            return done.stdout.splitlines(), ""
        said = _last_line(done.stderr, done.returncode)
        if done.returncode != NO_GRAPHICS:
            raise NoPictures(said)
        tried.append(f"{back_end}: {said}")
    done = run("robbdd_tools.agent.show_robot", arm, "-", *mounted, more={CHOICE: "disable"})
    if done.returncode != 0:
        raise NoPictures(_last_line(done.stderr, done.returncode))
    return done.stdout.splitlines(), nothing_renders(tried)


def _last_line(text: str, code: int) -> str:
    return (text.strip().splitlines() or [f"the rendering process ended with code {code}"])[-1]


def _render(folder: Path, what: str, output: Path, more: Iterable[str] = ()) -> list[str]:
    """Render with the first back end that works, and return the names of the pictures."""
    arguments = (str(folder.absolute()), what, str(output.absolute()), *more)
    tried: list[str] = []
    for back_end in back_ends():
        done = run("robbdd_tools.agent.render_run", *arguments, more={CHOICE: back_end})
        if done.returncode == 0:
            return done.stdout.splitlines()
        said = _last_line(done.stderr, done.returncode)
        if done.returncode != NO_GRAPHICS:
            raise NoPictures(said)
        tried.append(f"{back_end}: {said}")
    raise NoPictures(nothing_renders(tried))
