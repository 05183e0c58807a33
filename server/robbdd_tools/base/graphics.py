"""Graphics back ends of the engine on each operating system."""

from __future__ import annotations

import os
import sys

CHOICE, KEPT = "MUJOCO_GL", "ROBBDD_MUJOCO_GL"
"""The environment variable with the user's back end; the one that keeps its value in processes without graphics."""
NO_GRAPHICS = 3
"""Exit code of a rendering process if its back end does not work."""


def without_graphics() -> None:
    """Let this process load the engine without graphics: a broken back end must not prevent it."""
    os.environ.setdefault(KEPT, os.environ.get(CHOICE, ""))
    os.environ[CHOICE] = "disable"


def back_ends() -> tuple[str, ...]:
    """Return the values of ``MUJOCO_GL`` that can render without a display, best first.

    If the user has set ``MUJOCO_GL``, return only its value.
    """
    chosen = os.environ.get(KEPT, os.environ.get(CHOICE))
    if chosen:
        return (chosen,)
    match sys.platform:
        case "win32":
            return ("wgl",)
        case "darwin":
            return ("cgl", "glfw")
        case _:
            return ("egl", "osmesa")


def advice() -> str:
    """Return what to do when no back end works."""
    if sys.platform in ("win32", "darwin"):
        return "install the graphics driver and run this command in a desktop session"
    return "install EGL (libegl1 and libgl1) or OSMesa (libosmesa6), or set MUJOCO_GL=glfw where there is a display"


def nothing_renders(tried: list[str]) -> str:
    """Return that no picture can be rendered, with what each back end said."""
    return f"nothing here can render without a display: {advice()} ({'; '.join(tried)})"
