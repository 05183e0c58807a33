"""The figures of ``docs/campaigns.md``: ``python tests/campaign/study_figures.py many N`` and ``… causes N``.

- ``many``: a study of N executions whose agents need no time: executions per second of processor time, memory and size
  of the store, after each tenth.
- ``causes``: N repetitions of ``examples/pickplace`` in a study that keeps all traces: the processor time of an
  execution by cause. The agent's main thread is sampled every millisecond; storing and messages are measured in the
  process of the study.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import process_time, thread_time
from typing import Any
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).parents[1]))

from campaign.sampled_agent import SAMPLES
from campaign.study_agents import QuickAgent, write_study
from kit import EXAMPLES
from robbdd_tools.base import interpreter
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.run import scheduler
from robbdd_tools.run.recording import Recording
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.study_store import StudyStore

AGENT = "robbdd_tools.agent"
SAMPLED = Path(__file__).with_name("sampled_agent.py")
STUDY = 'import "m.bdd"\nStudy fetching {{ repeat: {} seed: 3 }}\n'
TRACED = 'import "pickplace.bdd"\nStudy p {{ repeat: {} seed: 1 traces: all 1000 MB }}\n'


@contextmanager
def timed(owner: type, name: str, spent: defaultdict[str, float]) -> Generator[None]:
    """Add the processor time of a method to ``spent``."""
    whole: Callable[..., Any] = getattr(owner, name)

    def method(self: object, *given: Any, **named: Any) -> Any:
        began = thread_time()
        try:
            return whole(self, *given, **named)
        finally:
            spent[name] += thread_time() - began

    with patch.object(owner, name, method):
        yield


def causes(number: int) -> None:
    """Print the processor time of an execution by cause."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "model"
        shutil.copytree(EXAMPLES / "pickplace", folder, ignore=shutil.ignore_patterns(".robbdd"))
        (folder / "robbdd.toml").touch()
        path = folder / "p.study"
        path.write_text(TRACED.format(number), encoding="utf-8")
        whole = interpreter._command  # pyright: ignore[reportPrivateUsage]  # it starts agents; no public name does

        def command(*arguments: str) -> Sequence[str]:
            own = arguments[:2] == ("-m", AGENT)
            return [sys.executable, str(SAMPLED), *arguments[2:]] if own else whole(*arguments)

        os.environ[SAMPLES] = str(Path(name) / "samples")
        study = load_study(path)
        spent: defaultdict[str, float] = defaultdict(float)
        with (
            patch.object(interpreter, "_command", command),
            timed(Recording, "take", spent),
            timed(StudyStore, "add", spent),
            StudyRun(study, study_folder(path), Policy(1), resumed=False) as run,
        ):
            began = process_time()
            for _ in run.progress():
                pass
            parent, total = process_time() - began, run.total
        rows: defaultdict[str, float] = defaultdict(float)
        for file in Path(name).glob("samples-*"):
            for line in file.read_text(encoding="utf-8").splitlines():
                seconds, _, what = line.partition(" ")
                rows[what] += float(seconds)
        agents = sum(rows.values())
        storing = spent["take"] + spent["add"]
        print(f"{total} executions; processor time of the agents {agents:.1f} s, of the study {parent:.1f} s")
        rows.update({"storing (study)": storing, "planning, messages, moving traces (study)": parent - storing})
        for what, seconds in sorted(rows.items(), key=lambda row: -row[1]):
            print(f"{1000 * seconds / total:8.1f} ms  {100 * seconds / (agents + parent):5.1f} %  {what}")
        recorded = rows["recording"] + rows["writing traces and margins"]
        print(f"storing costs {100 * storing / recorded:.1f} % on top of recording")


def many(number: int) -> None:
    """Print the rate, the memory and the size of the store of a long study."""
    with tempfile.TemporaryDirectory() as name, patch.object(scheduler, "Agent", QuickAgent):
        path = write_study(Path(name), STUDY.format(number // 4))
        study = load_study(path)
        with StudyRun(study, study_folder(path), Policy(2), resumed=False) as run:
            began, shown = process_time(), 0
            for progress in run.progress():
                if progress.finished * 10 // run.total > shown:
                    shown = progress.finished * 10 // run.total
                    rate, began = run.total / 10 / (process_time() - began), process_time()
                    counted = f"{progress.finished:8,} executions: {rate:6.0f} per second of processor time"
                    print(f"{counted}, {memory():5.0f} MB", flush=True)
        size = (study_folder(path) / "study.sqlite").stat().st_size
        print(f"store: {size / number:.0f} bytes an execution")


def memory() -> float:
    """Return the memory of this process in MB."""
    lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS"))


if __name__ == "__main__":
    {"many": many, "causes": causes}[sys.argv[1]](int(sys.argv[2]))
