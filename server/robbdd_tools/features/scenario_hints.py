"""Inlay hints that show the number of scenarios of each variant."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.checks.counting import scenario_count
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.elements import story_sites

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class ScenarioHint:
    """The inlay hint after the name of a variant. ``span`` is the absolute span of the name."""

    span: Span
    label: str


def scenario_hints(snapshot: Snapshot, uri: str, within: Span) -> list[ScenarioHint]:
    """Return a hint for each variant in a span of a file. A variant that uses an unknown set has no hint."""
    file = snapshot.file(uri)
    hints: list[ScenarioHint] = []
    for site in story_sites(snapshot, file, within) if file is not None else ():
        for scenario in scenarios(site):
            count, span = scenario_count(scenario), site.span(scenario.variant.name)
            if count is not None and within.contains(span.end):
                hints.append(ScenarioHint(span, f"{count:,} scenario{'' if count == 1 else 's'}"))
    return hints
