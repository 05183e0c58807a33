"""The version of the sentences of a feature, and remarks on edited sentences of the first version."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.files import load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.protocol.time_words import AMBIGUOUS, FIRST_WORDING, HEADER, wording_of

if TYPE_CHECKING:
    from pathlib import Path


@cache
def feature_wording(feature: Path) -> int:
    """Return the version of the sentences of a feature file that behave has already read. Raises ``OSError``."""
    return wording_of(load_text(feature, RESULT_SIZE))


def remarks_on_wording(edited: Iterable[str], wording: int) -> Iterator[str]:
    """Yield a remark on each edited sentence that only the first version of the wording understands.

    ``wording`` is the version of the feature.
    """
    for text in edited:
        found = AMBIGUOUS.search(text)
        if found is not None and wording == FIRST_WORDING:
            seconds = found["horizon"]
            yield (
                f"'{text}' is judged as 'for {seconds} seconds', because its feature has no line '{HEADER}'; with this "
                f"line, write 'for {seconds} seconds' or 'at some time within {seconds} seconds'"
            )
