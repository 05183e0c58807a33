"""A condition of several predicates that must all hold: ``whenever a and b``."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.catalog.api import Predicate

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray

Filler = TypeVar("Filler")
_SLOT = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class JointEvaluator:
    """Evaluates several predicates. Their slots are distinguished by the number of the predicate (``object-2``)."""

    predicates: tuple[Predicate, ...]

    def __call__(self, evidence: Evidence, arguments: Arguments) -> FloatArray:
        """Return the smallest margin at each sample, shape (n,).

        The margins have different units, so only the sign has a meaning. The result is NaN where a margin is NaN and no
        other margin is negative.
        """
        # Editors also read conditions, and do not load numpy.
        import numpy as np

        margins = np.stack([one.evaluate(evidence, own) for one, own in self.parts(arguments) if one.evaluate])
        unknown = np.isnan(margins)
        least: FloatArray = np.where(unknown, np.inf, margins).min(axis=0)
        return np.where((least >= 0) & unknown.any(axis=0), np.nan, least)

    def parts(self, arguments: Mapping[str, Filler]) -> list[tuple[Predicate, dict[str, Filler]]]:
        """Return each predicate with its own arguments."""
        return [
            (one, {slot.name: arguments[f"{slot.name}-{number}"] for slot in one.slots})
            for number, one in enumerate(self.predicates, start=1)
        ]


def joint_predicate(predicates: Sequence[Predicate]) -> Predicate:
    """Return the conjunction of predicates as one predicate; a single predicate is unchanged."""
    if len(predicates) == 1:
        return predicates[0]
    numbered = list(enumerate(predicates, start=1))
    slots = tuple(replace(slot, name=f"{slot.name}-{number}") for number, one in numbered for slot in one.slots)
    sentence = " and ".join(_SLOT.sub(rf"{{\1-{number}}}", one.sentence) for number, one in numbered)
    known = all(one.evaluate is not None for one in predicates)
    evaluate = JointEvaluator(tuple(predicates)) if known else None
    name = " and ".join(one.name for one in predicates)
    return Predicate(name, "", "", slots, sentence, "", "", evaluate)


def joint_arguments(arguments: Sequence[Mapping[str, Filler]]) -> Mapping[str, Filler]:
    """Return the arguments of a conjunction, given the arguments of each of its predicates."""
    if len(arguments) == 1:
        return arguments[0]
    return {f"{slot}-{number}": one for number, own in enumerate(arguments, 1) for slot, one in own.items()}


def parts_of(predicate: Predicate, arguments: Mapping[str, Filler]) -> list[tuple[Predicate, Mapping[str, Filler]]]:
    """Return the predicates of a conjunction with their arguments; a single predicate is unchanged."""
    if isinstance(predicate.evaluate, JointEvaluator):
        return list(predicate.evaluate.parts(arguments))
    return [(predicate, arguments)]
