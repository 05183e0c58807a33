"""Select scenarios of variants before they are generated, without generating the others."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.gherkin.covering import Cover, TooManyCombinations, cover
from robbdd_tools.gherkin.feature import Numbered
from robbdd_tools.gherkin.variations import at, bindings, count
from robbdd_tools.gherkin.where import Condition, WhereError, check_where, condition, parse_where
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Iri, Variant


@dataclass(frozen=True, slots=True)
class Wanted:
    """A user's selection. ``where`` filters the scenarios, and at most one other criterion reduces them further.

    - ``first`` and ``sample``: the number of scenarios to select from the whole model, the first ones or random ones.
    - ``strength``: each variant's covering array contains all combinations of values of this many variables.
    - ``seed``: determines the sample.
    """

    where: str | None = None
    first: int | None = None
    sample: int | None = None
    strength: int | None = None
    seed: int = 1


class SelectionError(RobbddError):
    """The selection is not possible. The message gives the reason."""


class Selected:
    """The selected scenarios of some variants.

    ``total`` is their number, or ``None`` if they would have to be generated to count them. ``covers`` maps each
    variant to its covering array.
    """

    def __init__(self, model: AcceptanceModel, variants: Sequence[Variant], wanted: Wanted) -> None:
        """Raise ``SelectionError`` if the selection is not possible."""
        self._variants = tuple(variants)
        self._conditions = _conditions(model, variants, wanted.where)
        self._indices: dict[Iri, Sequence[int]] = {}
        self._limits: dict[Iri, int] = {}
        self.covers: dict[Iri, Cover] = {}
        if wanted.strength is not None:
            self._cover(variants, wanted.strength)
        elif wanted.sample is not None:
            self._sample(variants, wanted.sample, random.Random(wanted.seed))
        elif wanted.first is not None:
            self._first(variants, wanted.first)
        self.total = self._total()

    def scenarios(self, variant: Variant) -> Iterator[Numbered]:
        """Yield the selected scenarios of a variant in written order, each with its number among all of the variant."""
        indices = self._indices.get(variant.iri)
        if indices is not None:
            return ((index + 1, at(variant.variation, index)) for index in indices)
        return islice(self._fitting(variant), self._limits.get(variant.iri))

    def is_empty(self) -> bool:
        """Return whether no scenario is selected. Scenarios are generated only up to the first selected one."""
        if self.total is not None:
            return self.total == 0
        return all(next(self.scenarios(variant), None) is None for variant in self._variants)

    def _fitting(self, variant: Variant) -> Iterator[Numbered]:
        fits = self._conditions.get(variant.iri)
        every = enumerate(bindings(variant.variation), start=1)
        return every if fits is None else (entry for entry in every if fits(tuple(entry[1].values())))

    def _total(self) -> int | None:
        total = 0
        for variant in self._variants:
            if variant.iri in self._indices:
                total += len(self._indices[variant.iri])
            elif variant.iri in self._limits:
                total += self._limits[variant.iri]
            elif variant.iri in self._conditions:
                return None
            else:
                total += count(variant.variation)
        return total

    def _cover(self, variants: Sequence[Variant], strength: int) -> None:
        for variant in variants:
            try:
                found = cover(variant.variation, strength, self._conditions.get(variant.iri))
            except TooManyCombinations as error:
                raise SelectionError(str(error)) from None
            self.covers[variant.iri] = found
            self._indices[variant.iri] = found.indices

    def _first(self, variants: Sequence[Variant], wanted: int) -> None:
        for variant in variants:
            if variant.iri in self._conditions:
                found = sum(1 for _ in islice(self._fitting(variant), wanted))
            else:
                found = min(wanted, count(variant.variation))
            self._limits[variant.iri] = found
            wanted -= found

    def _sample(self, variants: Sequence[Variant], wanted: int, dice: random.Random) -> None:
        """Draw a sample without replacement. Each set of scenarios is equally likely."""
        drawn: Sequence[tuple[int, int]]
        if self._conditions:
            fitting = (
                (place, number - 1) for place, variant in enumerate(variants) for number, _ in self._fitting(variant)
            )
            drawn = _reservoir(fitting, wanted, dice)
        else:
            drawn = _drawn([count(variant.variation) for variant in variants], wanted, dice)
        for place, variant in enumerate(variants):
            self._indices[variant.iri] = sorted(index for owner, index in drawn if owner == place)


def _conditions(model: AcceptanceModel, variants: Sequence[Variant], where: str | None) -> dict[Iri, Condition]:
    if where is None:
        return {}
    try:
        expression = parse_where(where)
        check_where(expression, model, variants)
    except WhereError as error:
        raise SelectionError(str(error)) from None
    return {variant.iri: condition(expression, model, variant) for variant in variants}


def _drawn(sizes: Sequence[int], wanted: int, dice: random.Random) -> list[tuple[int, int]]:
    """Draw a sample from groups of known sizes by Floyd's algorithm.

    The effort is one step for each drawn scenario, however large the groups are.
    """
    total = sum(sizes)
    chosen: set[int] = set()
    for top in range(max(0, total - wanted), total):
        candidate = dice.randrange(top + 1)
        chosen.add(top if candidate in chosen else candidate)
    drawn: list[tuple[int, int]] = []
    owner, below = 0, 0
    for index in sorted(chosen):
        while index - below >= sizes[owner]:
            below += sizes[owner]
            owner += 1
        drawn.append((owner, index - below))
    return drawn


def _reservoir(entries: Iterator[tuple[int, int]], wanted: int, dice: random.Random) -> list[tuple[int, int]]:
    """Sample from an unknown number of entries in one pass."""
    kept: list[tuple[int, int]] = []
    for seen, entry in enumerate(entries):
        if seen < wanted:
            kept.append(entry)
        elif (place := dice.randrange(seen + 1)) < wanted:
            kept[place] = entry
    return kept
