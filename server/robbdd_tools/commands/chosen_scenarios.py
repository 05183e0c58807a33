"""Select scenarios for commands that write them, and print the coverage of covering arrays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.gherkin.select import Selected, SelectionError, Wanted
from robbdd_tools.workbench.plan import NO_SCENARIO_FITS, Coverage, coverage

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Variant


def selection(model: AcceptanceModel, variants: Sequence[Variant], wanted: Wanted) -> Selected | None:
    """Return the selected scenarios of some variants. If there are none, print the reason and return ``None``."""
    try:
        selected = Selected(model, variants, wanted)
    except SelectionError as error:
        fail(str(error))
        return None
    if selected.is_empty():
        fail(NO_SCENARIO_FITS)
        return None
    print_coverage(coverage(model, selected.covers))
    return selected


def print_coverage(covers: Iterable[Coverage]) -> None:
    """Print how many value combinations each covering array covers."""
    for cover in covers:
        print_note(str(cover))
