"""Parse predicates and conditions in sentences of features, without their time constraints.

A definition is written in parentheses: ``( "a" is located at "b" and not ( "a" is held by "r" ) )``.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from functools import cache
from itertools import count
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.compound import compound_predicate
from robbdd_tools.monitor.predicate_definitions import Combination, Operand, Passed
from robbdd_tools.protocol.clauses import AnyOf, Condition, Filler, joint_condition

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.catalog.api import Predicate, Slot
    from robbdd_tools.monitor.predicate_definitions import Definition

QUOTED = r'(?:[^"\\]|\\.)*'
"""Contents of double quotes; a backslash escapes the next character."""
NOT, GROUP = r"not \( (?P<inner>.*) \)", r"\( (?P<inner>.*) \)"
"""A negation, and an alternative or enumeration."""
DEFINITION = r'(?:not )?\( (?:not |\( )*".*? \)'
"""The definition of a predicate in place of its phrase."""
ANY = "any of "
Named = Sequence["Predicate"]
_ESCAPE = re.compile(r"\\(?:u([0-9a-f]{4})|(.))")
_NAMED = {"n": "\n", "r": "\r", "t": "\t"}
_OPAQUE = re.compile(rf'"{QUOTED}"|\\.')


def sentence_pattern(sentence: str) -> str:
    """Return the regular expression of a catalog sentence, with one named group for each slot."""
    parts = re.split(r"\{(\w+)\}", sentence)
    pieces = [re.escape(text) for text in parts[::2]]
    groups = [f"(?P<{name}>{QUOTED})" for name in parts[1::2]]
    return pieces[0] + "".join(group + piece for group, piece in zip(groups, pieces[1:], strict=True))


def unescaped(text: str) -> str:
    """Return the string that the user wrote, from its escaped form in a step."""
    return _ESCAPE.sub(lambda match: chr(int(match[1], 16)) if match[1] else _NAMED.get(match[2], match[2]), text)


def read_condition(text: str | None, named: Named) -> Condition | None:
    """Return the predicates in a part of a sentence, as one; ``None`` if one of them is unknown."""
    found = [] if text is None else [_one(part, named) for part in split(text, " and ")]
    known = [one for one in found if one is not None]
    return joint_condition(known) if len(known) == len(found) else None


def read_definition(text: str, named: Named) -> Condition | None:
    """Return the predicate that a definition describes, with its values; ``None`` if the text is no definition."""
    values: dict[str, Filler] = {}
    definition = _definition(text, named, values, (f"value_{number}" for number in count(1)))
    if definition is None:
        return None
    return Condition(compound_predicate(text, text, tuple(values), definition), values)


def fillers(match: re.Match[str], slots: tuple[Slot, ...]) -> dict[str, Filler]:
    """Return the values of slots in a sentence that matches a ``sentence_pattern``."""
    return {slot.name: _filler(match[slot.name]) for slot in slots}


def _one(text: str, named: Named) -> Condition | None:
    own = tuple((one, re.compile(sentence_pattern(one.sentence))) for one in named)
    for predicate, pattern in (*_predicates(), *own):
        if (match := pattern.fullmatch(text)) is not None:
            return Condition(predicate, fillers(match, predicate.slots))
    return read_definition(text, named) if re.fullmatch(DEFINITION, text) else None


def _definition(text: str, named: Named, values: dict[str, Filler], names: Iterator[str]) -> Definition | None:
    """Return a definition. Each value in it becomes a parameter, which is added to ``values``."""
    for operator, pattern in (("not", NOT), ("", GROUP)):
        match = re.fullmatch(pattern, text)
        if match is None or not balanced(match["inner"]):
            continue
        if operator:
            inner = _definition(f"( {match['inner']} )", named, values, names)
            return None if inner is None else Combination("not", (inner,))
        return _joined(match["inner"], named, values, names)
    found = _one(text, named)
    if found is None:
        return None
    passed = {slot: Passed(next(names)) for slot in found.arguments}
    values |= {passed[slot].parameter: filler for slot, filler in found.arguments.items()}
    return Operand(found.predicate, passed)


def _joined(text: str, named: Named, values: dict[str, Filler], names: Iterator[str]) -> Definition | None:
    """Return the definition inside parentheses; ``None`` if it has both *and* and *or*."""
    for operator in ("and", "or"):
        parts = split(text, f" {operator} ")
        if len(parts) > 1:
            operands = [_definition(part, named, values, names) for part in parts]
            known = tuple(operand for operand in operands if operand is not None)
            return Combination(operator, known) if len(known) == len(operands) else None
    return _definition(text, named, values, names)


@cache
def _predicates() -> tuple[tuple[Predicate, re.Pattern[str]], ...]:
    predicates = load_catalog().predicates.values()
    return tuple((predicate, re.compile(sentence_pattern(predicate.sentence))) for predicate in predicates)


def _filler(text: str) -> Filler:
    some = text.startswith(f"{ANY}[")
    listed = unescaped(text.removeprefix(ANY) if some else text)
    if text.startswith("\\") or not (listed.startswith("[") and listed.endswith("]")):
        return unescaped(text)
    try:
        value: list[object] = ast.literal_eval(listed)
    except (ValueError, SyntaxError):
        return unescaped(text)
    elements = tuple(str(element) for element in value)
    return AnyOf(elements) if some else elements


def balanced(text: str) -> bool:
    """Return whether the parentheses outside of quotes are balanced."""
    depth = 0
    for char in _outside_quotes(text):
        depth += (char == "(") - (char == ")")
        if depth < 0:
            return False
    return depth == 0


def split(text: str, separator: str) -> list[str]:
    """Split at separators outside quotes and parentheses."""
    bare = _outside_quotes(text)
    parts: list[str] = []
    depth, start = 0, 0
    for index, char in enumerate(bare):
        depth += (char == "(") - (char == ")")
        if depth == 0 and bare.startswith(separator, index):
            parts.append(text[start:index])
            start = index + len(separator)
    return [*parts, text[start:]]


def _outside_quotes(text: str) -> str:
    """Return a text of the same length in which ``_`` replaces quoted text and escaped characters."""
    return _OPAQUE.sub(lambda match: "_" * len(match[0]), text)
