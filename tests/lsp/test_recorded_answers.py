"""The extension's tests read answers of the real server; this test notices when they are out of date."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, cast

import pytest

from lsp.recorded_answers import FOLDER, recorded_answers, written

DIGITS = 1e-5
"""Relative difference of numbers between machines."""


def same(one: Any, other: Any) -> bool:
    """Return whether two answers are equal but for the last digits of numbers and the contents of packed arrays."""
    match one, other:
        case dict(), dict():
            first, second = cast("dict[str, Any]", one), cast("dict[str, Any]", other)
            skipped = {"data"} if {"data", "shape", "type"} <= first.keys() else set[str]()
            return list(first) == list(second) and all(same(first[key], second[key]) for key in first.keys() - skipped)
        case list(), list():
            first, second = cast("list[Any]", one), cast("list[Any]", other)
            return len(first) == len(second) and all(map(same, first, second))
        case float() | int(), float() | int():
            return one == pytest.approx(other, rel=DIGITS, abs=DIGITS)
        case _:
            return one == other


@pytest.mark.usefixtures("forked_processes")
async def test_the_recorded_answers_are_those_of_the_server(tmp_path: Path) -> None:
    answers = await recorded_answers(tmp_path)
    if os.environ.get("ROBBDD_ACCEPT"):
        FOLDER.mkdir(exist_ok=True)
        for name, answer in answers.items():
            (FOLDER / f"{name}.json").write_text(written(answer), encoding="utf-8")
    recorded = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in FOLDER.glob("*.json")}
    assert recorded.keys() == answers.keys()
    stale = [name for name, answer in answers.items() if not same(recorded[name], json.loads(written(answer)))]
    assert stale == [], "record them anew by ROBBDD_ACCEPT=1 and read what has changed"
