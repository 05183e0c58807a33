"""Find the clauses that prove little in a run: they could not have failed, or they held from the start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.monitor.vacuity import Range, is_constant, joined
from robbdd_tools.monitor.verdict import NEVER_APPLIED, Outcome

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ClauseSpec

HELD_BEFORE = "its predicate already held before the behaviour began, in every execution"


@dataclass(slots=True)
class Vacuity:
    """Collects for each clause the reasons why its verdict proves little."""

    _said: dict[str, str] = field(default_factory=dict[str, str])
    _ranges: dict[str, list[Range]] = field(default_factory=dict[str, list[Range]])
    _executions: dict[str, int] = field(default_factory=dict[str, int])
    _applied: dict[str, bool] = field(default_factory=dict[str, bool])
    _held: dict[str, list[bool]] = field(default_factory=dict[str, list[bool]])

    def judged(self, clause: ClauseSpec, judged: ClauseJudged) -> None:
        """Record one verdict on a clause."""
        if judged.vacuous == NEVER_APPLIED:
            self._applied.setdefault(clause.iri, False)
        elif judged.vacuous:
            self._said.setdefault(clause.iri, judged.vacuous)
        elif judged.verdict != Outcome.UNKNOWN:
            self._applied[clause.iri] = True

    def varied(self, clause: ClauseSpec, ranges: Sequence[Sequence[float]]) -> None:
        """Record the range of the margin of each of a clause's fluents in one execution."""
        if not ranges:
            return
        known = self._ranges.get(clause.iri, [])
        found: list[Range] = [(low, high) for low, high in ranges]
        # A set of another size has other fluents; then all are pooled.
        if known and len(known) != len(found):
            known, found = [joined(known)], [joined(found)]
        self._ranges[clause.iri] = [joined(list(pair)) for pair in zip(known or found, found, strict=True)]
        self._executions[clause.iri] = self._executions.get(clause.iri, 0) + 1

    def held(self, clause: ClauseSpec, before: bool | None) -> None:
        """Record whether a clause already held before the behaviour in one execution; ``None`` if this is unknown."""
        if before is not None:
            self._held.setdefault(clause.iri, []).append(before)

    def reasons(self) -> Mapping[str, str]:
        """Map the IRI of each clause that could not have failed, or that held from the start, to the reason."""
        constant = {iri: self._never_varied(iri) for iri, found in self._ranges.items() if all(map(is_constant, found))}
        held = {iri: HELD_BEFORE for iri, found in self._held.items() if all(found)}
        never = {iri: NEVER_APPLIED for iri, applied in self._applied.items() if not applied}
        return {**held, **constant, **never, **self._said}

    def _never_varied(self, iri: str) -> str:
        margins = " and ".join(f"{low:.4g}" for low, _ in self._ranges[iri])
        count = self._executions[iri]
        times = "the execution" if count == 1 else f"all {count} executions"
        return f"its predicate had the same margin ({margins}) throughout {times}"
