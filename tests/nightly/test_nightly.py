"""Short versions of the nightly tools: every target, a soak, and that each tool detects its faults."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.nightly import fuzz as fuzzing
from tests.nightly.fuzz import Finding, case, fuzz, run_case
from tests.nightly.others import SMOKE
from tests.nightly.planted import FAULTY, PLANTED
from tests.nightly.processes import Usage
from tests.nightly.session import Fault
from tests.nightly.soak import Soak, judged, soak
from tests.nightly.targets import TARGETS

from kit import ROOT

SEED = 1
CASES = {"parser": 15, "requests": 1, "channel": 1, "store": 3, "query": 4, "formatter": 8}
"""Cases of each target here; ten of the others."""
SECONDS = 8.0


@pytest.mark.parametrize("name", list(TARGETS))
def test_damaged_input_costs_a_message(name: str) -> None:
    for number in range(CASES.get(name, 10)):
        run_case(TARGETS[name], case(TARGETS[name], SEED, number))


def test_nothing_is_stale_or_unanswered_after_many_edits_and_a_run(tmp_path: Path) -> None:
    done = soak(SEED, SECONDS, tmp_path)
    assert min(done.edits, done.requests, done.checks) > 0


def test_a_case_depends_on_seed_and_number_only() -> None:
    for target in TARGETS.values():
        assert case(target, 7, 3) == case(target, 7, 3)
    assert case(TARGETS["parser"], 7, 3) != case(TARGETS["parser"], 7, 4)


@pytest.mark.parametrize("name", list(PLANTED))
def test_a_case_that_raises_crashes_or_hangs_is_found(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    target, said = PLANTED[name]
    # The fuzzing process imports the target by its name.
    monkeypatch.syspath_prepend(str(ROOT))  # pyright: ignore[reportUnknownMemberType]
    monkeypatch.setattr(fuzzing, "PATIENCE", 3.0)
    found: list[Finding] = []
    while not found:
        fuzz(target, SEED, 2.0, found.append)
    assert (found[0].number, found[0].seed) == (FAULTY, SEED)
    assert said in found[0].said
    folder = found[0].save(target, tmp_path)
    assert folder.name == f"{name}-{SEED}-{FAULTY}"
    assert "seed 1, case 3" in (folder / "FINDING.txt").read_text(encoding="utf-8")
    assert (folder / "case.txt").read_bytes() == case(target, SEED, FAULTY)["case.txt"]


def test_the_tests_that_are_run_with_other_versions_exist() -> None:
    assert [path for path in SMOKE if not (ROOT / path).is_file()] == []


def used(memory: int = 100, descriptors: int = 20, threads: int = 10, processes: int = 3) -> Usage:
    return Usage((memory << 20, *([0] * (processes - 1))), descriptors, threads)


def measured(*samples: Usage) -> Soak:
    return Soak(SEED, samples=[(float(at), sample) for at, sample in enumerate(samples)])


def test_memory_that_settles_after_warm_up_is_none_of_a_fault() -> None:
    warm = [used(10), used(60), used(99)]
    assert "+" in judged(measured(*warm, *(used(100 + step % 3) for step in range(9))))


@pytest.mark.parametrize("held", ["memory", "descriptors", "threads", "processes"])
def test_growth_after_warm_up_is_a_fault(held: str) -> None:
    grows: list[Any] = [used(**{held: 10 + 20 * step}) for step in range(12)]
    with pytest.raises(Fault, match=f"{held} grow"):
        judged(measured(*grows))
