"""Selects scenarios for a command, and tells what was selected or why that cannot be done."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from robbdd_tools.commands.output import print_note
from robbdd_tools.gherkin.select import Selected, SelectionError, Wanted

if TYPE_CHECKING:
    from robbdd_tools.graph.model import AcceptanceModel, Variant


def selection(model: AcceptanceModel, variants: Sequence[Variant], wanted: Wanted) -> Selected | None:
    """Return the wanted scenarios of some variants; prints why, and returns ``None``, when there are none."""
    try:
        selected = Selected(model, variants, wanted)
    except SelectionError as error:
        print_note(f"robbdd: {error}")
        return None
    if selected.is_empty():
        print_note("robbdd: no scenario fits the selection")
        return None
    describe(model, selected)
    return selected


def describe(model: AcceptanceModel, selected: Selected) -> None:
    """Tell how much of the combinations of values a covering array covers."""
    for iri, cover in selected.covers.items():
        number = len(cover.indices)
        covered = f"{cover.covered} of {cover.possible} combinations"
        print_note(f"{model.curie(iri)}: {number} scenario{'' if number == 1 else 's'} with {covered}")
