"""The packages whose tests are measured by mutation, and which of their modules are mutated."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Room:
    """A package of ``robbdd_tools``: only its own folder of tests may kill its mutants."""

    name: str
    modules: tuple[str, ...] = ("*",)
    """Names of its modules, without ``.py``; ``*`` means all of them."""

    reading_source: tuple[str, ...] = ()
    """Tests that read the source of the modules, and so cannot be run on mutants."""

    @property
    def tests(self) -> tuple[str, ...]:
        """Arguments of pytest. Tests of the simulator take seconds each and would be run for every survivor."""
        ignored = (f"--ignore=tests/{self.name}/{file}" for file in self.reading_source)
        return f"tests/{self.name}", "-m", "not physics", *ignored

    @property
    def patterns(self) -> tuple[str, ...]:
        return tuple(f"src/robbdd_tools/{self.name}/{module}.py" for module in self.modules)


ROOMS = {
    room.name: room
    for room in (
        Room("monitor"),
        Room("checks", reading_source=("test_pages.py",)),
        Room("names"),
        Room("gherkin", ("select", "where", "covering", "variations")),
        Room("judging"),
        Room("world", ("placement", "pose", "extent", "clearance", "overlaps", "put_down")),
        Room(
            "run",
            ("scheduler", "agent_worker", "message_order", "message_check", "related_scenarios", "iterations"),
        ),
    )
}
"""Rooms by name. ``gherkin`` is the selection of scenarios, ``world`` is placement, ``run`` is the scheduler."""
