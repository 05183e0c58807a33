"""Explicit lists of scenarios, such as those chosen in an editor or failed in a run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import Execution
    from robbdd_tools.protocol.specs import ScenarioSpec


@dataclass(frozen=True, slots=True)
class Listed:
    """Scenarios of one variant (its IRI) in a list.

    - ``numbers``: the numbers of the scenarios (from 1); if it is empty, all scenarios.
    - ``execution``: the IRI of the execution that executes them; if it is missing, any execution or none.
    - ``repetitions``: the numbers of the repetitions (from 1); if it is empty, all repetitions.
    """

    variant: str
    numbers: frozenset[int] | None = None
    execution: str | None = None
    repetitions: frozenset[int] | None = None

    def admits(self, number: int) -> bool:
        """Return whether the scenario with this number of the variant is listed."""
        return self.numbers is None or number in self.numbers

    def admits_spec(self, spec: ScenarioSpec) -> bool:
        """Return whether a specified execution is listed. It must be an execution of the variant."""
        by = None if spec.execution is None else spec.execution.iri
        return (
            self.admits(spec.variation)
            and (None in (self.execution, by) or self.execution == by)
            and (self.repetitions is None or spec.repetition in self.repetitions)
        )


class Choice:
    """An explicit list of scenarios."""

    def __init__(self, entries: Iterable[Listed]) -> None:
        self._entries: dict[str, list[Listed]] = {}
        for entry in entries:
            self._entries.setdefault(entry.variant, []).append(entry)

    def entries(self, variant: str) -> Sequence[Listed]:
        """Return the entries of the list for a variant."""
        return self._entries.get(variant, ())

    def every(self) -> Iterable[Listed]:
        """Yield all entries of the list."""
        for entries in self._entries.values():
            yield from entries

    def admits(self, variant: str, number: int) -> bool:
        """Return whether a scenario is listed, no matter by which execution."""
        return any(entry.admits(number) for entry in self.entries(variant))

    def admits_spec(self, spec: ScenarioSpec) -> bool:
        """Return whether a specified execution of a scenario is listed."""
        return any(entry.admits_spec(spec) for entry in self.entries(spec.variant))

    def admits_execution(self, execution: Execution) -> bool:
        """Return whether any scenario of an execution is listed."""
        return any(entry.execution in (None, execution.iri) for entry in self.entries(execution.variant))
