"""Quantities that are measured only in the windows of the clauses that need them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.geometry import GAP
from robbdd_tools.judging.quantities import fluents_with_quantity
from robbdd_tools.monitor.time import During, NoWindow, Window, occurrence_times, window
from robbdd_tools.world.gaps import GapSampler
from robbdd_tools.world.reaching import ReachSampler

if TYPE_CHECKING:
    from robbdd_tools.monitor.time import TimeConstraint
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.clauses import Clause
    from robbdd_tools.world.simulation import Simulation


class OnDemandQuantities:
    """Measures reach margins and gaps from the recorded states of a simulation, each sample once."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._reaches = ReachSampler(simulation)
        self._gaps = GapSampler(simulation)

    def measure(self, clause: Clause, trace: Trace, rows: range | None = None) -> None:
        """Measure the quantities of a clause at the samples ``rows``, or else in the windows of its fluents."""
        cast = self._simulation.world.cast
        for fluent, one in fluents_with_quantity(clause, "reach"):
            if one["agent"] in self._simulation.robots and one["object"] in cast.objects:
                for chosen in _ranges(fluent.time, trace) if rows is None else (rows,):
                    self._reaches.sample(one["agent"], one["object"], chosen)
        for fluent, one in fluents_with_quantity(clause, GAP):
            for chosen in _ranges(fluent.time, trace) if rows is None else (rows,):
                self._gaps.sample(one["one"], one["other"], chosen)

    def added_to(self, trace: Trace) -> Trace:
        """Return a trace with all measurements."""
        size = len(trace.times)
        return replace(trace, reaches=self._reaches.record(size), gaps=self._gaps.record(size))


def _ranges(constraint: TimeConstraint, trace: Trace) -> Iterator[range]:
    """Yield the samples of each window of a constraint, or of the recorded part of the window."""
    constraints = [constraint]
    if not isinstance(constraint, During) and constraint.which == "every" and not constraint.number:
        times = occurrence_times(constraint, trace)
        if isinstance(times, NoWindow):
            return
        constraints = [replace(constraint, number=number) for number in range(1, len(times) + 1)]
    for one in constraints:
        selected = window(one, trace)
        rows = selected.recorded if isinstance(selected, NoWindow) else selected
        if isinstance(rows, Window):
            yield range(rows.first, rows.last + 1)
