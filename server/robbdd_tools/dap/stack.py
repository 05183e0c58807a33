"""The stack of a pause: the clause, the scenario and its template, each at its place in the text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robbdd_tools.protocol.pauses import Paused
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.clause_debugging import DebuggedScenario
    from robbdd_tools.workbench.diagnostics import Place


def stack_frames(
    scenario: DebuggedScenario, spec: ScenarioSpec, paused: Paused, first_line: int
) -> list[dict[str, Any]]:
    """Return the frames; the id of a clause's frame is 0.

    ``first_line`` is the number to subtract from lines, which count from 1.
    """
    frames: list[dict[str, Any]] = []
    clause = next((one for one in spec.clauses if one.line == paused.line), None)
    if clause is not None:
        iri = clause.iri
        if paused.hits and clause.parts and paused.hits[0].part < len(clause.parts):
            iri = clause.parts[paused.hits[0].part]
        place = scenario.place(iri) or scenario.place(clause.iri)
        frames.append(_frame(0, scenario.title(clause), place, first_line))
    frames.append(_frame(1, spec.name.rpartition(":")[2], scenario.place(spec.variant), first_line))
    template = scenario.template()
    if template is not None:
        frames.append(_frame(2, template.name, template.place, first_line))
    return frames


def _frame(number: int, name: str, place: Place | None, first_line: int) -> dict[str, Any]:
    if place is None or place.path is None:
        return {"id": number, "name": name, "line": 0, "column": 0, "presentationHint": "subtle"}
    source = {"name": place.path.name, "path": str(place.path)}
    # State no end, or VS Code would scroll to the end of a long line and hide its beginning.
    start = {"line": place.line - first_line, "column": place.column - first_line}
    return {"id": number, "name": name, "source": source, **start}
