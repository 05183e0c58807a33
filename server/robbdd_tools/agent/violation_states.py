"""Store the state of the world at each violation of a clause, so that pictures can be rendered later."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import load_text
from robbdd_tools.base.limits import RESULT_SIZE

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

FOLDER = "moments"


@dataclass(frozen=True, slots=True)
class ViolationState:
    """A violation: number of the scenario, feature line of the clause, time (s), and joint positions."""

    index: int
    line: int
    at: float
    state: tuple[float, ...]


class ViolationStates:
    """The violations in a run folder.

    Each scenario has one file with one JSON object in each line, in the order of detection. Several agent processes may
    work in one folder, each on its own scenarios.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder / FOLDER

    def clear(self, index: int) -> None:
        """Delete the violations of an earlier execution of a scenario. Raises ``OSError``."""
        self._file(index).unlink(missing_ok=True)

    def keep(self, index: int, line: int, at: float, state: FloatArray) -> None:
        """Add a violation; raises ``OSError``."""
        moment = ViolationState(index, line, at, tuple(state.tolist()))
        self._folder.mkdir(exist_ok=True)
        with self._file(index).open("a", encoding="utf-8") as file:
            file.write(json.dumps(asdict(moment)) + "\n")

    def __iter__(self) -> Iterator[ViolationState]:
        """Yield all violations, scenario by scenario. Raises ``OSError`` or ``ValueError`` if a file cannot be read."""
        for path in sorted(self._folder.glob("*.jsonl")):
            for line in load_text(path, RESULT_SIZE).splitlines():
                try:
                    fields = json.loads(line)
                    yield ViolationState(fields["index"], fields["line"], fields["at"], tuple(fields["state"]))
                except (KeyError, TypeError) as error:
                    raise ValueError(f"{path} does not contain moments") from error

    def _file(self, index: int) -> Path:
        return self._folder / f"{index:06}.jsonl"
