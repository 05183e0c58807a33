"""The breakpoints that an editor has set, and the variables that it can ask for during a pause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.dap.conditions import InvalidCondition, moments_of
from robbdd_tools.protocol.pauses import ClauseBreakpoint, Moment, SetBreakpoints
from robbdd_tools.workbench.clause_debugging import DebuggedScenario, NoClause, clause_places

if TYPE_CHECKING:
    from robbdd_tools.dap.variables import Variable
    from robbdd_tools.protocol.pauses import Hit
    from robbdd_tools.protocol.specs import ScenarioSpec


@dataclass(frozen=True, slots=True)
class SetBreakpoint:
    """A breakpoint of the editor on clauses, by its number."""

    number: int
    clauses: frozenset[str]
    moments: tuple[str, ...]


@dataclass(slots=True)
class Breakpoints:
    """All breakpoints of a session. Lines are counted from 1 here."""

    scenario: DebuggedScenario
    everywhere: tuple[str, ...] = ()
    _by_file: dict[Path, list[SetBreakpoint]] = field(default_factory=dict[Path, list[SetBreakpoint]])
    _count: int = 0

    def set_in(self, path: Path, stated: Sequence[tuple[int, str | None]]) -> list[dict[str, Any]]:
        """Replace the breakpoints of a file, given by their lines and conditions; return an answer for each of them."""
        own: list[SetBreakpoint] = []
        answers: list[dict[str, Any]] = []
        for line, condition in stated:
            self._count += 1
            try:
                moments = moments_of(condition)
                place, clauses = self.scenario.clauses_at(path, line)
            except (NoClause, InvalidCondition) as error:
                answers.append({"id": self._count, "verified": False, "line": line, "message": str(error)})
                continue
            own.append(SetBreakpoint(self._count, clauses, moments))
            answers.append({"id": self._count, "verified": True, "line": place.line})
        self._by_file[path] = own
        return answers

    def order(self, spec: ScenarioSpec) -> SetBreakpoints:
        """Return the order that sets all breakpoints in an execution."""
        every = [one for own in self._by_file.values() for one in own]
        placed = ((line, part, one.moments) for one in every for line, part in clause_places(spec, one.clauses))
        return SetBreakpoints(tuple(ClauseBreakpoint(*one) for one in placed), self.everywhere)

    def hit(self, spec: ScenarioSpec, hits: Sequence[Hit]) -> list[int]:
        """Return the numbers of the breakpoints that moments have hit."""
        return [
            one.number
            for own in self._by_file.values()
            for one in own
            for line, part in clause_places(spec, one.clauses)
            if any(hit.line == line and part in (None, hit.part) and hit.moment in one.moments for hit in hits)
        ]

    def set_everywhere(self, filters: Sequence[object]) -> None:
        """Pause at some moments of any clause."""
        self.everywhere = tuple(moment for moment in Moment if moment in filters)


def source_path(source: Mapping[str, Any]) -> Path:
    """Return the file of a source that an editor names by its path or its URI."""
    path = str(source.get("path") or "")
    found = uri_to_path(path) if path.startswith("file:") else Path(path)
    return found or Path(path)


class VariableHandles:
    """Numbers with which the editor requests the variables in a scope or a variable. They are valid for one pause."""

    def __init__(self) -> None:
        self._inner: list[tuple[Variable, ...]] = []

    def clear(self) -> None:
        """Forget all numbers."""
        self._inner.clear()

    def of(self, inner: tuple[Variable, ...]) -> int:
        """Return the number of some variables; 0 if there are none."""
        if not inner:
            return 0
        self._inner.append(inner)
        return len(self._inner)

    def variables(self, number: object) -> tuple[Variable, ...]:
        """Return the variables that have a number; none if the number is from an earlier pause."""
        known = isinstance(number, int) and 0 < number <= len(self._inner)
        return self._inner[number - 1] if isinstance(number, int) and known else ()
