"""Write the definitions of named predicates in words: as a comment of a feature, or in place of their phrase."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.gherkin.words import condition_words, filled
from robbdd_tools.monitor.compound import SETS, definition_of, leaves
from robbdd_tools.monitor.predicate_definitions import Combination, Definition, Operand, Passed
from robbdd_tools.protocol.clauses import AnyOf

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate
    from robbdd_tools.protocol.clauses import Condition, Filler


def predicate_words(predicate: Predicate, arguments: Mapping[str, Filler], *, expanded: bool) -> str:
    """Return a predicate with its values as words.

    If ``expanded`` is true, the words of a named predicate are its definition, in parentheses if it joins others.
    """
    definition = definition_of(predicate)
    if definition is None or not expanded or not _can_be_expanded(definition, arguments):
        return filled(predicate.sentence, arguments)
    return _defined(definition, arguments)


def whenever_words(condition: Condition | None, *, expanded: bool) -> str:
    """Return the text of a clause's condition, which follows the predicate in a sentence; empty if there is none."""
    if condition is None or not expanded:
        return condition_words(condition)
    return " whenever " + " and ".join(
        predicate_words(one.predicate, one.arguments, expanded=True) for one in condition.parts
    )


def meaning(predicate: Predicate, arguments: Mapping[str, Filler], *, expanded: bool) -> Iterator[str]:
    """Yield the meaning of a named predicate's phrase as a sentence, unless the phrase is expanded."""
    definition = definition_of(predicate)
    if definition is not None and not (expanded and _can_be_expanded(definition, arguments)):
        yield f"{filled(predicate.sentence, arguments)} means {_defined(definition, arguments, outer=True)}"


def _can_be_expanded(definition: Definition, arguments: Mapping[str, Filler]) -> bool:
    """Return whether the words of a definition say the same as the phrase.

    They do not if a value stands for several elements: *the same* element must satisfy the whole definition. A set that
    a predicate takes as a whole is one value.
    """
    single = {slot: filler for slot, filler in arguments.items() if not isinstance(filler, AnyOf)}
    return len(single) == len(arguments) and all(
        isinstance(own[slot.name], str) or (isinstance(own[slot.name], tuple) and slot.kind in SETS)
        for predicate, own in leaves(definition, single)
        for slot in predicate.slots
    )


def _defined(definition: Definition, arguments: Mapping[str, Filler], *, outer: bool = False) -> str:
    """Return a definition in words, with its values. Named predicates in it are also replaced by their definitions.

    Joined predicates are in parentheses, unless ``outer`` is true.
    """
    match definition:
        case Operand(predicate, fillers):
            own = {slot: arguments[one.parameter] if isinstance(one, Passed) else one for slot, one in fillers.items()}
            inner = definition_of(predicate)
            return filled(predicate.sentence, own) if inner is None else _defined(inner, own, outer=outer)
        case Combination("not", (operand,)):
            return f"not ( {_defined(operand, arguments, outer=True)} )"
        case Combination(operator, operands):
            joined = f" {operator} ".join(_defined(operand, arguments) for operand in operands)
            return joined if outer else f"( {joined} )"
