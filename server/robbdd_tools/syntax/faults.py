"""Messages about syntax faults: the position, the text found there and the expected text."""

from __future__ import annotations

import re
from dataclasses import replace

from robbdd_tools.base.document import Span
from robbdd_tools.base.quantity_units import units_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.containing_declarations import misplaced_part
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix
from robbdd_tools.syntax.foreign_units import foreign_unit
from robbdd_tools.syntax.joined import joining_word
from robbdd_tools.syntax.named_groups import named_group
from robbdd_tools.syntax.near_misses import near_miss, other_file
from robbdd_tools.syntax.parsed import Expectation, Rejected
from robbdd_tools.syntax.quantified_sets import set_in_quantifier
from robbdd_tools.syntax.recover import Fault
from robbdd_tools.syntax.setting_units import unit_of_setting
from robbdd_tools.syntax.unknown_behaviours import behaviour_fault
from robbdd_tools.syntax.unknown_phrases import phrase_fault

LONGEST_WORD = 40
"""Maximum number of characters of the user's text that a message repeats."""

_RULE_WORDS = {
    "NameText": "a name",
    "ColumnNameText": "a property",
    "TextLiteral": "a string in quotes",
    "NumberLiteral": "a number",
    "TableRule": "the rule '|---|'",
    "NamespacePath": "the name of a namespace",
    "AnySetPath": "the name of a set",
    "ModuleNameText": "the name of a module",
    "TreePath": "the name of a kinematic tree",
    "TreeTemplatePath": "the name of a kinematic tree template",
    "TreeNodePath": "the name of a node of a behaviour tree",
    "ImplementationPath": "the name of a behaviour implementation",
    "ProviderPath": "the name of an observation provider",
    "PolicyPath": "the name of an observation policy",
    "LogPath": "the name of a robot log",
}
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?![\w%.])")
_QUOTED_QUANTITY = re.compile(r"([\"'])([-+]?[\d.]+\s*(?:m/s|deg/s|deg|rad|mm|cm|ms|kg|g|m|s|N|%))\1")
_EMPTY_LINE = re.compile(r"[ \t\r]*\n([ \t]*)\r?\n")
_DECLARATIONS = frozenset({"Event", "Task", "Requirement", "Predicate", "Scenario", "User", "Behaviour"})
_STARTS = frozenset({"import", "ns"})
_PLACES = {
    "Given": "'Given:' must come before 'When:' or 'for all'",
    "When": "'When:' must come after the clauses of 'Given:' or 'Then:', or after 'for all'",
    "for all": "'for all' is written instead of 'When:', which is inside its braces",
    "Then": "'Then:' must come after 'When:' or 'for all'",
}
"""Part of a scenario → message on its required order. Users often get the order wrong."""
_WHENEVER = re.compile(r"whenever\b")
_NO_BEHAVIOUR = (
    "'When:' needs a behaviour after its events: 'Behaviour name { duration: … <agent> … }' or '<agent> picks …'"
)
_UNJOINED = "clauses joined by '{0}' need parentheses around all of them: '( … {0} … )'"
_PART = re.compile(r"(?:Given|When|Then)(?=\s*:)|for(?=\s+all\b)")
_EMPTY = re.compile(r"(?<![\w\-.])(Given|When|Then)\s*:\s*\Z")
_GIVEN = re.compile(r"(?<![\w\-.])(Given)\s*:")
_WHEN = re.compile(r"(?<![\w\-.])(?:When\s*:|for\s+all\b)")
_NOTHING = "nothing is written between '{0}:' and '{1}': write what belongs to '{0}:' below it, or remove it"
# If a part is out of order, its keyword is read as a clause name. Then one of these tokens is missing after it.
_AS_NAMES = {
    "holds": re.compile(r"(?<![\w\-.])(Given|When|Then)\s*:\s*\Z"),
    ":": re.compile(r"(?<![\w\-.])(for)\s+all\Z"),
}


def fault_in(language: str, text: str, fault: Fault) -> SyntaxFault:
    """Return an error as a fault for users."""
    found = _rejected(language, text, fault.rejected)
    if found.fix is not None or fault.repair is None or fault.repair.text is None:
        return found
    return replace(found, fix=SyntaxFix(fault.repair.span, fault.repair.text, fault.repair.title))


def expected_words(expectation: Expectation) -> list[str]:
    """Describe the text that is allowed at a place: first keywords in quotes, then names, strings and numbers."""
    literals = [f"'{literal}'" for literal in sorted(expectation.literals)]
    named = (rule for rule in expectation.rules if rule in _RULE_WORDS or rule.endswith("Path"))
    rules = sorted({_RULE_WORDS.get(rule) or _path_words(rule) for rule in named})
    return literals + rules


def _path_words(rule: str) -> str:
    words = "".join(f" {letter.lower()}" if letter.isupper() else letter for letter in rule.removesuffix("Path"))
    return f"the name of a{'n' if words.lstrip()[:1] in 'aeiou' else ''}{words}"


def _rejected(language: str, text: str, rejected: Rejected) -> SyntaxFault:
    span = _token(text, rejected.offset)
    found = _shown(text, span)
    misplaced = _misplaced(text, rejected)
    if misplaced is not None:
        return misplaced
    joining = joining_word(text, rejected.offset) if ":" in rejected.expected.literals else None
    if joining is not None:
        return SyntaxFault(joining, _UNJOINED.format(text[joining.start : joining.end]))
    explaining = (
        _comma_before_whenever,
        phrase_fault,
        behaviour_fault,
        foreign_unit,
        _without_unit,
        unit_of_setting,
        set_in_quantifier,
        named_group,
        near_miss,
    )
    known = next((fault for explain in explaining if (fault := explain(text, rejected)) is not None), None)
    if known is not None:
        return known
    if rejected.offset == 0 and rejected.expected.literals >= _STARTS:
        message = other_file(text, 0) or misplaced_part(language, text, 0) or f"'{found}' does not begin a declaration"
        return SyntaxFault(span, message)
    words = expected_words(rejected.expected)
    if not words:
        return trailing_fault(language, text, rejected.offset)
    expected = " or ".join(words) if len(words) < 3 else ", ".join(words[:-1]) + " or " + words[-1]
    if not found:
        place = _blank_line(text) if "}" in rejected.expected.literals else None
        return SyntaxFault(place or last_token(text), f"the declaration ends too early: expected {expected}")
    return SyntaxFault(span, f"unexpected '{found}': expected {expected}")


def _misplaced(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of a scenario part that is out of order or has no content."""
    part = _PART.match(text, rejected.offset)
    label = _EMPTY.search(text, 0, rejected.offset)
    if part is not None and label is not None:
        return SyntaxFault(Span(*label.span(1)), _NOTHING.format(label[1], "for all" if part[0] == "for" else part[0]))
    if text[rejected.offset : rejected.offset + 1] in ("", "}") and rejected.expected.literals >= {"When", "for"}:
        given = list(_GIVEN.finditer(text, 0, rejected.offset))
        after = given and _WHEN.search(text, 0, given[-1].start())
        if after and "Given" not in rejected.expected.literals:
            return SyntaxFault(Span(*given[-1].span(1)), _PLACES["Given"])
    if part is None and len(rejected.expected.literals) == 1:
        (missed,) = rejected.expected.literals
        as_name = _AS_NAMES.get(missed)
        end = rejected.offset if missed == "holds" else _token(text, rejected.offset).end
        part = None if as_name is None else as_name.search(text, 0, end)
    word = None if part is None else part[part.lastindex or 0]
    if part is None or word is None or word in rejected.expected.literals:
        return None
    span = Span(part.start(), part.start() + len(word))
    if word == "Then" and {"Behaviour", "event"} <= rejected.expected.literals:
        return SyntaxFault(span, _NO_BEHAVIOUR)
    return SyntaxFault(span, _PLACES["for all" if word == "for" else word])


def _comma_before_whenever(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of a condition that is written as a time constraint: in English, it often has a comma."""
    if not _WHENEVER.match(text, rejected.offset):
        return None
    comma = len(text[: rejected.offset].rstrip()) - 1
    if comma < 0 or text[comma] != ",":
        return None
    span = Span(comma, comma + 1)
    message = "no comma comes before 'whenever': <predicate> whenever <condition>, <time constraint>"
    return SyntaxFault(span, message, SyntaxFix(span, ""))


def _without_unit(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of a number without a unit, or of a quantity in quotes."""
    if "QuantityLiteral" not in rejected.expected.rules:
        return None
    number = _NUMBER.match(text, rejected.offset)
    if number is not None:
        unit = _unit_after(text[: rejected.offset])
        message = f"a number needs a unit here: write for example '{number[0]} {unit}', or name a variable"
        span, written = Span(*number.span()), f"{number[0]} {unit}"
        return SyntaxFault(span, message, SyntaxFix(span, written, f"Change to '{written}'"))
    quoted = _QUOTED_QUANTITY.match(text, rejected.offset)
    if quoted is None:
        return None
    fix = SyntaxFix(Span(*quoted.span()), quoted[2])
    return SyntaxFault(fix.span, "a quantity is written without quotes", fix)


def _unit_after(head: str) -> str:
    """Return a unit of the quantity that phrases expect after the words at the end of a text."""
    words = " ".join(head[-LONGEST_WORD:].split())
    for word in load_catalog().predicates.values():
        before, _, after = word.phrase.partition("#")
        own = before.rpartition(">")[2].strip()
        slot = next((slot for slot in word.slots if slot.name == after.partition(" ")[0]), None)
        if slot is not None and own and words.endswith(own):
            return "deg" if slot.dimension == "angle" else units_of(slot.dimension)[0]
    return "m"


def trailing_fault(language: str, text: str, offset: int) -> SyntaxFault:
    """Return the fault of text after the end of a declaration."""
    token = _token(text, offset)
    word = text[token.start : token.end]
    if word in ("and", "or") and text.startswith("Predicate"):
        return SyntaxFault(token, f"a definition with '{word}' needs parentheses around all of it: '( … {word} … )'")
    if word.capitalize() in _DECLARATIONS - {word}:
        written = word.capitalize()
        fix = SyntaxFix(token, written, f"Change to '{written}'")
        return SyntaxFault(token, f"a declaration begins with a capital letter: '{written}'", fix)
    unexpected = f"unexpected '{_shown(text, token)}' after the end of the declaration"
    return SyntaxFault(token, other_file(text, offset) or misplaced_part(language, text, offset) or unexpected)


def _shown(text: str, span: Span) -> str:
    word = text[span.start : span.end]
    return word if len(word) <= LONGEST_WORD else word[: LONGEST_WORD - 1] + "…"


def _token(text: str, offset: int) -> Span:
    """Return the span of the word or symbol at ``offset``."""
    end = offset
    while end < len(text) and (text[end].isalnum() or text[end] in "_-"):
        end += 1
    if end == offset and offset < len(text):
        end = offset + 1
    return Span(offset, end)


def _blank_line(text: str) -> Span | None:
    """Return the position of an empty line after the last word of a text, where a closing brace would be."""
    end = len(text.rstrip())
    match = _EMPTY_LINE.match(text, end)
    return None if match is None else Span(match.start(1), match.end(1))


def last_token(text: str) -> Span:
    """Return the span of the last word or symbol of a text."""
    end = len(text.rstrip())
    start = end
    while start > 0 and not text[start - 1].isspace():
        start -= 1
    return Span(start, end)
