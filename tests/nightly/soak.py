"""A long session of edits, requests and runs: memory, descriptors and threads stay constant, diagnostics current."""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

from tests.nightly.processes import Usage, usage
from tests.nightly.session import Fault, Session

GROWTH = 0.10
"""Growth of memory after warm-up, as a fraction, from which on it counts as a leak."""
WARM_UP = 0.3
"""The part of a soak that fills the caches."""
ROUNDS_OF_CHECK = 40
"""Rounds between two comparisons with a check and memory measurements."""
ROUNDS_OF_RUN = 60
POOL = min(32, (os.cpu_count() or 1) + 4)
"""Threads of asyncio's pool, which it starts one by one as they are needed."""


@dataclass
class Soak:
    """What a soak has done and measured."""

    seed: int
    rounds: int = 0
    edits: int = 0
    requests: int = 0
    runs: int = 0
    checks: int = 0
    samples: list[tuple[float, Usage]] = field(default_factory=list[tuple[float, Usage]])

    def settled(self) -> tuple[Sequence[Usage], Sequence[Usage]]:
        """Return the samples of the first and of the last third after warm-up."""
        after = [used for at, used in self.samples if at >= WARM_UP * self.samples[-1][0]]
        third = max(1, len(after) // 3)
        return after[:third], after[-third:]

    def growth(self) -> float:
        """Return the growth of all processes' memory after warm-up, as a fraction."""
        first, last = (statistics.median(used.total for used in part) for part in self.settled())
        return last / first - 1

    def report(self) -> str:
        """Return a one-line summary."""
        first, last = self.settled()
        before, after = (statistics.median(used.total for used in part) / 2**20 for part in (first, last))
        return (
            f"{self.edits} edits, {self.requests} requests, {self.runs} runs, {self.checks} comparisons with a cold "
            f"check: memory {before:.0f} → {after:.0f} MiB ({self.growth():+.1%}), descriptors "
            f"{first[0].descriptors} → {last[-1].descriptors}, threads {first[0].threads} → {last[-1].threads}, "
            f"processes {len(first[0].memory)} → {len(last[-1].memory)}"
        )


def soak(seed: int, seconds: float, kept: Path) -> Soak:
    """Use a server for some time; raises ``Fault`` with the texts in ``kept`` when something is wrong."""
    random = Random(f"soak {seed}")
    done = Soak(seed)
    with tempfile.TemporaryDirectory(prefix="robbdd-soak-") as name:
        session = Session(Path(name) / "project", Path(name) / "server.log", random)
        try:
            began = time.monotonic()
            while time.monotonic() - began < seconds or not done.samples:
                _round(session, random, done)
                if done.rounds % ROUNDS_OF_CHECK == 0:
                    _look(session, done, began)
            session.close()
            session.check_log()
        except BaseException:
            session.save(kept / "texts")
            session.kill()
            (kept / "server.log").write_bytes((Path(name) / "server.log").read_bytes())
            raise
    return done


def _round(session: Session, random: Random, done: Soak) -> None:
    done.rounds += 1
    document = random.choice(session.documents)
    asked: list[int] = []
    for _ in range(random.randrange(1, 6)):
        session.edit(document)
        asked += [session.request(random.choice(session.documents)) for _ in range(random.randrange(4))]
    if random.random() < 0.05:
        session.reopen(document)
    if random.random() < 0.05:
        session.touch()
    if random.random() < 0.3:
        session.restore(document)
    if done.rounds % ROUNDS_OF_RUN == 0:
        session.restore(session.documents[-2])
        asked.append(session.run(cancelled=random.random() < 0.5))
        done.runs += 1
    session.answered(asked)
    done.edits, done.requests = session.edits, sum(session.asked.values())


def _look(session: Session, done: Soak, began: float) -> None:
    session.compare_with_check()
    session.check_log()
    # The same texts each time, so that memory is compared with its like.
    for document in session.documents:
        session.restore(document)
    session.compare_with_check()
    done.checks += 2
    done.samples.append((time.monotonic() - began, usage(session.client.pid)))
    print(f"{done.samples[-1][0]:6.0f} s  {done.rounds} rounds  {_described(done.samples[-1][1])}", file=sys.stderr)


def _described(used: Usage) -> str:
    memory = " + ".join(f"{each / 2**20:.1f}" for each in used.memory)
    return f"{used.total / 2**20:.1f} MiB = {memory}, {used.descriptors} descriptors, {used.threads} threads"


def judged(done: Soak) -> str:
    """Return the report of a soak; raises ``Fault`` when something has grown after warm-up."""
    first, last = done.settled()
    if done.growth() >= GROWTH:
        raise Fault(f"memory grows: {done.report()}")
    for held in ("descriptors", "threads", "processes"):
        slack = POOL if held == "threads" else 0
        if min(getattr(used, held) for used in last) > max(getattr(used, held) for used in first) + slack:
            raise Fault(f"{held} grow: {done.report()}")
    return done.report()
