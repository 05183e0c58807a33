"""``robbdd doctor``: print versions, test every part of the installation, and say how to fix failures."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from enum import StrEnum
from functools import partial
from pathlib import Path

from robbdd_tools.base.printable import printable_json
from robbdd_tools.commands import FINDINGS, OK, installation, selftest
from robbdd_tools.commands.installation import Unavailable
from robbdd_tools.commands.output import print_document, print_line

REPORT = "this is a fault of RobBDD: report it with the output of `robbdd doctor --json`"


class State(StrEnum):
    """State of a part. A missing optional part does not fail the command."""

    WORKS = "works"
    MISSING = "missing"
    FAILED = "failed"


SIGNS = {State.WORKS: "✔", State.MISSING: "–", State.FAILED: "✗"}


@dataclass(frozen=True, slots=True)
class Part:
    """One part of the installation and its test result.

    ``fix`` says how to repair the part; it is empty if the part works.
    """

    name: str
    state: State
    detail: str
    fix: str = ""


def doctor(path: Path, as_json: bool) -> int:
    """Test the installation and the store of the project at ``path``; return the exit code."""
    parts: list[Part] = []
    for part in _parts(path):
        parts.append(part)
        if not as_json:
            _print(part)
    healthy = all(part.state is not State.FAILED for part in parts)
    if as_json:
        document = {"healthy": healthy, "parts": [asdict(part) for part in parts]}
        print_document(f"{printable_json(document, 1)}\n")
    return OK if healthy else FINDINGS


def _parts(path: Path) -> Iterator[Part]:
    for name, test in installation.TESTS.items():
        yield examine(name, test)
    with tempfile.TemporaryDirectory(prefix="robbdd-", ignore_cleanup_errors=True) as folder:
        for name, test in selftest.TESTS.items():
            yield examine(name, partial(test, Path(folder) / "project"))
    yield examine("store", partial(selftest.store, path))


def examine(name: str, test: Callable[[], str]) -> Part:
    """Test a part of the installation and return its state.

    ``test`` returns a description of the part. If the part does not work, ``test`` raises ``Unavailable`` or any other
    exception.
    """
    try:
        return Part(name, State.WORKS, test())
    except Unavailable as reason:
        return Part(name, State.MISSING if reason.optional else State.FAILED, str(reason), reason.fix)
    except Exception as error:  # Any failure is a result to report; doctor itself must not crash.
        return Part(name, State.FAILED, f"{type(error).__name__}: {error}", REPORT)


def _print(part: Part) -> None:
    first, *others = part.detail.splitlines() or [""]
    print_line(f"{SIGNS[part.state]} {part.name:<12}{first}")
    for line in (*others, *([f"Fix: {part.fix}"] if part.fix else ())):
        print_line(f"  {'':<12}{line}")
