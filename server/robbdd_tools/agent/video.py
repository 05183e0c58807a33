"""Make videos of an execution that show its events."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.writing import replacing_bytes
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.picture import Camera
from robbdd_tools.world.scene import local_name

if TYPE_CHECKING:
    from robbdd_tools.agent.execution import Execution

SIZE = (640, 400)
"""Width and height of a frame, pixels."""
STRIDE = 5
"""Number of control ticks between frames: this makes 12.5 frames per simulated second."""
QUALITY = 70
"""Compression quality of the frames, in per cent."""
TEXT, STRIP = 16, 26
"""Height of letters and of the text strip at the bottom, pixels."""
DARK, WHITE, RED = (20, 22, 26), (255, 255, 255), (255, 110, 100)


class NoVideo(Exception):
    """The library that writes videos is not installed."""


@dataclass(frozen=True, slots=True)
class Violation:
    """The violation of a clause, which is given by its name, at the time ``at`` (s)."""

    at: float
    clause: str


def write_video(path: Path, execution: Execution, title: str, violations: Sequence[Violation]) -> None:
    """Write a finished execution as an animated WebP picture that plays in real time.

    Each frame shows the scenario, the time, the latest event and the clauses violated so far. Raises ``NoVideo``
    without Pillow, ``NoPicture`` if no back end can render, ``OSError`` if the file cannot be written.
    """
    try:
        pillow = import_module("PIL.Image")
        draw, fonts = import_module("PIL.ImageDraw"), import_module("PIL.ImageFont")
    except ImportError as error:
        raise NoVideo("videos need Pillow: pip install 'robbdd-tools[video]'") from error
    font = fonts.load_default(TEXT)
    trace = execution.trace
    camera = Camera(execution.simulation, SIZE, plain=True)

    def frame(row: int) -> Any:
        time = float(trace.times[row])
        picture = pillow.fromarray(camera.take_state(execution.simulation.recorder.states[row]))
        pen = draw.Draw(picture)
        events = [local_name(stamp.name) for stamp in trace.events if stamp.time <= time + TICK / 2]
        said = f"{title}   {time:5.2f} s   {events[-1] if events else ''}"
        lines = [(SIZE[1] - STRIP, said, WHITE)]
        violated = [one.clause for one in violations if one.at <= time + TICK / 2]
        lines += [(index * STRIP, f"violated: {clause}", RED) for index, clause in enumerate(violated)]
        for top, text, color in lines:
            pen.rectangle((0, top, SIZE[0], top + STRIP), fill=DARK)
            pen.text((8, top + 3), text, font=font, fill=color)
        return picture

    try:
        first, *others = map(frame, range(0, len(trace.times), STRIDE))
    finally:
        camera.close()
    duration = round(1000 * STRIDE * TICK)
    options = {"duration": duration, "loop": 0, "quality": QUALITY, "method": 2}
    with replacing_bytes(path) as file:
        first.save(file, format="WEBP", save_all=True, append_images=others, **options)
