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
    """The inlay hint after the name of a variant. ``span`` is the name's absolute span, ``variant`` its IRI."""

    span: Span
    count: int
    variant: str | None

    @property
    def label(self) -> str:
        """The number of scenarios in words."""
        return f"{self.count:,} scenario{'' if self.count == 1 else 's'}"


def scenario_hints(snapshot: Snapshot, uri: str, within: Span) -> list[ScenarioHint]:
    """Return a hint for each variant in a span of a file. A variant that uses an unknown set has no hint."""
    file = snapshot.file(uri)
    if file is None:
        return []
    hints: list[ScenarioHint] = []
    for site in story_sites(snapshot, file, within):
        for scenario in scenarios(site):
            count, span = scenario_count(scenario), site.span(scenario.variant.name)
            if count is not None and within.contains(span.end):
                known = file.definitions.get(scenario.clauses.path)
                hints.append(ScenarioHint(span, count, None if known is None else known.iri))
    return hints
