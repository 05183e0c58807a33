"""Keeps the state of the world at the moment at which a clause was violated, for pictures of it later."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

FILE = "moments.jsonl"


@dataclass(frozen=True, slots=True)
class Moment:
    """Scenario number ``index``, the feature line of the clause, the time (s), the engine's joint positions."""

    index: int
    line: int
    at: float
    state: tuple[float, ...]


class Moments:
    """The moments of a run folder, one JSON object per line, in the order in which they were found."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / FILE

    def clear(self) -> None:
        """Forget those of an earlier run; raises ``OSError``."""
        self._path.unlink(missing_ok=True)

    def keep(self, index: int, line: int, at: float, state: FloatArray) -> None:
        """Add a moment; raises ``OSError``."""
        moment = Moment(index, line, at, tuple(state.tolist()))
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(asdict(moment)) + "\n")

    def __iter__(self) -> Iterator[Moment]:
        """Yield the moments; raises ``OSError`` or ``ValueError`` when they cannot be read."""
        if not self._path.is_file():
            return
        for line in self._path.read_text(encoding="utf-8").splitlines():
            try:
                fields = json.loads(line)
                yield Moment(fields["index"], fields["line"], fields["at"], tuple(fields["state"]))
            except (KeyError, TypeError) as error:
                raise ValueError(f"{self._path} holds something else than moments") from error
