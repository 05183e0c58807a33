"""Targets with planted faults, to test the fuzzer itself."""

from __future__ import annotations

import os
import time
from pathlib import Path
from random import Random

from tests.nightly.fuzz import Files, Target

FAULTY = 3
"""The case that shows the fault."""


def _numbered(random: Random) -> Files:
    return {"case.txt": str(random.random()).encode()}


def _is_faulty(target: str, folder: Path) -> bool:
    wanted = _numbered(Random(f"{target} 1 {FAULTY}"))["case.txt"]
    return (folder / "case.txt").read_bytes() == wanted


def _raises(folder: Path) -> None:
    if _is_faulty("raises", folder):
        raise KeyError("planted")


def _crashes(folder: Path) -> None:
    if _is_faulty("crashes", folder):
        os._exit(7)


def _hangs(folder: Path) -> None:
    while _is_faulty("hangs", folder):
        time.sleep(1)


PLANTED = {
    "raises": (Target("raises", _numbered, _raises), "KeyError: 'planted'"),
    "crashes": (Target("crashes", _numbered, _crashes), "ended with code 7"),
    "hangs": (Target("hangs", _numbered, _hangs), "no end within"),
}
"""Target and what its finding says."""
