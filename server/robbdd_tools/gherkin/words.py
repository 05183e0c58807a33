"""Write values in the sentences of steps."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

from robbdd_tools.gherkin import text
from robbdd_tools.protocol.clauses import AnyOf, Condition, Filler


class Placeholder(str):
    """The value of a variable in a Scenario Outline, which is the name of its column."""

    __slots__ = ()


def word(filler: Filler) -> str:
    """Return a value as written inside the quotes of a sentence."""
    match filler:
        case Placeholder():
            return f"<{filler}>"
        case AnyOf(elements):
            return f"any of {text.set_inside_quotes(elements)}"
        case str():
            return text.inside_quotes(filler)
        case _:
            return text.set_inside_quotes(filler)


def filled(sentence: str, fillers: Mapping[str, Filler]) -> str:
    """Return a sentence in which fillers replace the ``{slots}``. Slots without a filler stay."""
    parts = list(_slots(sentence))
    for index in range(1, len(parts), 2):
        filler = fillers.get(parts[index])
        parts[index] = f"{{{parts[index]}}}" if filler is None else word(filler)
    return "".join(parts)


def condition_words(condition: Condition | None) -> str:
    """Return the text of a clause's condition, which follows the predicate in a sentence; empty if there is none."""
    return "" if condition is None else f" whenever {filled(condition.predicate.sentence, condition.arguments)}"


# Not str.format: a user's template must not reach attributes or items of our objects.
@cache
def _slots(sentence: str) -> tuple[str, ...]:
    """Split a sentence at its ``{slots}``. The result alternates between text and slot names."""
    return tuple(re.split(r"\{(\w[\w-]*)\}", sentence))
