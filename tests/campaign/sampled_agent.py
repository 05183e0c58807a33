"""``python sampled_agent.py RUN_FOLDER``: an agent whose processor time is counted by cause (see ``study_figures``)."""

from __future__ import annotations

import os
import runpy
import sys
import threading
from collections import defaultdict
from pathlib import Path
from time import clock_gettime, pthread_getcpuclockid
from types import FrameType

PERIOD = 0.001
"""Seconds between two samples."""
SAMPLES = "ROBBDD_SAMPLES"
"""Environment variable: the beginning of the names of the files to which agents write."""
OUTER = (
    ("scenario_run.py", ("set_up",), "setting up the scene"),
    ("scenario_run.py", ("_write_trace", "_curves", "_report_ranges"), "writing traces and margins"),
)
"""Functions to which everything counts that they call."""
INNER = (
    (("contact_forces.py", "touch_forces.py", "recorder.py", "holding.py", "on_demand_quantities.py"), "recording"),
    (("/monitor/", "/judging/", "/catalog/predicates/"), "judging"),
    (("channel.py", "/protocol/"), "messages"),
    (("/world/", "behaviour", "/user_code/"), "controller, and steps outside of the engine"),
    (("/behave/",), "behave"),
)
"""Parts of files to which the innermost frame counts."""


def cause(frame: FrameType | None) -> str:
    """Return the cause to which a sample counts. Before the first scenario, it is the start of the process."""
    frames: list[tuple[str, str]] = []
    while frame is not None:
        frames.append((frame.f_code.co_filename, frame.f_code.co_name))
        frame = frame.f_back
    if not any(file.endswith(("hooks.py", "scenario_run.py")) for file, _ in frames):
        return "behave" if any("/behave/" in file for file, _ in frames) else "start"
    for part, names, found in OUTER:
        if any(file.endswith(part) and name in names for file, name in frames):
            return found
    if frames[0][1] == "_substeps":
        return "mj_step"
    for file, _ in frames:
        for parts, found in INNER:
            if any(part in file for part in parts):
                return found
    return "others"


def sampled_agent(folder: str) -> None:
    """Execute the agent of a run folder, and write the processor time of its main thread to the file ``SAMPLES``."""
    counts: defaultdict[str, float] = defaultdict(float)
    main, ended = threading.main_thread().ident or 0, threading.Event()
    clock = pthread_getcpuclockid(main)

    def sample() -> None:
        before, rounds = 0.0, 0
        while not ended.wait(PERIOD):
            now = clock_gettime(clock)
            frames = sys._current_frames()  # pyright: ignore[reportPrivateUsage]  # the only way to another thread's stack
            counts[cause(frames.get(main))] += now - before
            before, rounds = now, rounds + 1
            if rounds % 100 == 0:
                note()

    def note() -> None:
        # The study ends its agents by a signal, after which nothing can be written.
        lines = "".join(f"{number} {name}\n" for name, number in counts.items())
        Path(f"{os.environ[SAMPLES]}-{os.getpid()}").write_text(lines, encoding="utf-8")

    threading.Thread(target=sample, daemon=True).start()
    sys.argv = ["agent", folder]
    try:
        runpy.run_module("robbdd_tools.agent", run_name="__main__")
    finally:
        ended.set()
        note()


if __name__ == "__main__":
    sampled_agent(sys.argv[1])
