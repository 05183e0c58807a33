"""Fuzzing: cases generated from a seed and a number, checked in a separate process, saved if one shows a fault."""

from __future__ import annotations

import multiprocessing
import tempfile
import time
import traceback
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from random import Random

Files = Mapping[str, bytes]
"""A case's input: the files of its folder."""
PATIENCE = 120.0
"""Seconds after which a case counts as hanging."""
MEMORY = 6 * 2**30
"""Bytes of address space of a fuzzing process, where the system limits it; the engine's libraries reserve much."""


@dataclass(frozen=True, slots=True)
class Target:
    """Something that is fuzzed: ``make`` returns a case, ``check`` raises when its handling is at fault."""

    name: str
    make: Callable[[Random], Files]
    check: Callable[[Path], None]


@dataclass(frozen=True, slots=True)
class Finding:
    """A case that shows a fault."""

    target: str
    seed: int
    number: int
    said: str

    def save(self, target: Target, kept: Path) -> Path:
        """Write input and error into a new folder, for ``--replay``; return the folder."""
        folder = kept / f"{self.target}-{self.seed}-{self.number}"
        write_case(folder, case(target, self.seed, self.number))
        (folder / "FINDING.txt").write_text(
            f"target {self.target}, seed {self.seed}, case {self.number}\n"
            f"replay: python -m tests.nightly --replay {folder.name}\n\n{self.said}\n",
            encoding="utf-8",
            errors="replace",
        )
        return folder


def case(target: Target, seed: int, number: int) -> Files:
    """Return a case's input, always the same for a seed and a number."""
    return target.make(Random(f"{target.name} {seed} {number}"))


def write_case(folder: Path, files: Files) -> None:
    """Write a case's input into a folder."""
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def read_case(folder: Path) -> Files:
    """Return the files of a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def run_case(target: Target, files: Files) -> None:
    """Check one case in a temporary folder; exceptions of the check pass through."""
    with tempfile.TemporaryDirectory(prefix="robbdd-fuzz-") as name:
        write_case(Path(name), files)
        target.check(Path(name))


def fuzz(target: Target, seed: int, seconds: float, report: Callable[[Finding], None]) -> int:
    """Check cases for some time, in a process that may crash or hang; returns how many were checked."""
    deadline = time.monotonic() + seconds
    number = 0
    while time.monotonic() < deadline:
        number, finding = _until_fault(target, seed, number, deadline)
        if finding is not None:
            report(finding)
    return number


def _until_fault(target: Target, seed: int, first: int, deadline: float) -> tuple[int, Finding | None]:
    """Check cases from a number on until one is at fault or time is up; returns the next number and the fault."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    worker = context.Process(target=_work, args=(target, seed, first, theirs), daemon=True)
    worker.start()
    theirs.close()
    number, began = first, time.monotonic()
    try:
        while time.monotonic() < deadline or time.monotonic() - began < 1:
            if not ours.poll(PATIENCE):
                return number + 1, Finding(target.name, seed, number, f"no end within {PATIENCE:.0f} s")
            number, said = ours.recv()
            if said:
                return number + 1, Finding(target.name, seed, number, said)
        return number, None
    except EOFError:
        worker.join()
        return number + 1, Finding(target.name, seed, number, f"the process ended with code {worker.exitcode}")
    finally:
        worker.kill()
        worker.join()


def _work(target: Target, seed: int, number: int, parent: Connection) -> None:
    _limit_memory()
    with suppress(BrokenPipeError):
        while True:
            parent.send((number, ""))
            try:
                run_case(target, case(target, seed, number))
            except Exception:
                parent.send((number, traceback.format_exc()))
                return
            number += 1


def _limit_memory() -> None:
    try:
        import resource
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
