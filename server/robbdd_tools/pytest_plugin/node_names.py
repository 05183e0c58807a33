"""Names of stories and scenarios in node ids. They are readable, unique, and the same in every session."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from robbdd_tools.base.printable import printable
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.report import value_words

LONGEST = 120
"""Maximum characters of the values in a name."""


def local_name(iri: str) -> str:
    """Return the last part of an IRI or CURIE, without the characters at which pytest splits node ids."""
    local = iri.replace("#", "/").rsplit("/", 1)[-1].rsplit(":", 1)[-1]
    return printable(local).replace("[", "(").replace("::", ":")


def scenario_names(specs: Sequence[ScenarioSpec]) -> list[str]:
    """Return the names of the executions of one story, for example ``part-to-bin[cube0-left_ws]``.

    The brackets contain the name of the ``.bddx`` execution, if there is one, and then the values in the order of the
    variables. A name does not depend on the selection. From the second repetition on, it includes the number of the
    repetition.
    """
    names = [_name(spec, numbered=False) for spec in specs]
    count = Counter(names)
    return [
        name if count[name] == 1 and len(name) <= LONGEST else _name(spec, numbered=True)
        for name, spec in zip(names, specs, strict=True)
    ]


def _name(spec: ScenarioSpec, *, numbered: bool) -> str:
    execution = [] if spec.execution is None else [local_name(spec.execution.iri)]
    values = [printable(value_words("", value).removeprefix(" = ")) for value in spec.values.values()]
    words = "-".join([*execution, *values])
    if numbered:
        words = f"{words[:LONGEST]}-#{spec.variation}"
    if spec.repetition > 1:
        words = f"{words}-repetition{spec.repetition}"
    return f"{local_name(spec.variant)}[{words.removeprefix('-')}]" if words else local_name(spec.variant)
