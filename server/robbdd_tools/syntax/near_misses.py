"""Recognise common mistakes of newcomers, for whom the intended text is more helpful than the expected words."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix

if TYPE_CHECKING:
    from collections.abc import Callable

    from robbdd_tools.syntax.parsed import Rejected

_NAME = r"[^\W\d][\w\-]*"


@dataclass(frozen=True, slots=True)
class NearMiss:
    """A common mistake.

    - ``before`` and ``at``: match the text before the parser's error and at the error.
    - ``expected``: a keyword or symbol that the parser expects there.
    - ``fix``: returns the text that replaces the match of ``at``; ``""`` removes the match.
    - ``rewrite``: returns another span and its new text.
    """

    before: str
    at: str
    message: str
    expected: str = ""
    fix: Callable[[str], str] | None = None
    rewrite: Callable[[re.Match[str]], SyntaxFix] | None = None


def _as_set(before: re.Match[str]) -> SyntaxFix:
    return SyntaxFix(Span(before.start("var"), before.start("var")), "set ")


def _without_words(before: re.Match[str]) -> SyntaxFix:
    return SyntaxFix(Span(before.start(), before.end()), "")


_OWN_PREDICATE = """the language has no such predicate: write 'pred("{x} is …", x=<variable>)', \
which a policy or a step function judges"""
_CORRECT = "the language has no such predicate: write '<workspace> is correct for <object>'"
_COUNT = """a phrase does not count: write '( var x exists in <set> ) such that { … }' for at least one element, \
or 'for all ( var x in <set> ) { … }' for each of them"""
_DURATION = "a duration is required by 'it takes less than 12 s, from <start> until <end>'"
_DISTANCE = "a distance is required by '<a> is nearer than 0.5 m to <b>', or by '<a> is farther than 0.5 m from <b>'"
_NEAR_MISSES = (
    NearMiss(
        r"\bholds\s*\(\s*\Z", r"(?:at (?:least|most)|exactly|all|every|each|some|any|no|none|both)\b(?!-)", _COUNT, "<"
    ),
    NearMiss(r"\bholds\s*\(\s*\Z", r"(?:the )?(?:duration|time|total time)\b(?!-)", _DURATION, "<"),
    NearMiss(r"\bholds\s*\(\s*\Z", r"takes\b(?!-)", _DURATION, "<", "it {}".format),
    NearMiss(r"\bholds\s*\(\s*\Z", r"(?:the )?distance\b(?!-)", _DISTANCE, "<"),
    NearMiss(
        rf"\bset\s+var\s*<\s*{_NAME}(?:\.{_NAME})*\s*>\s*:\s*\{{\s*\Z",
        r"[<\d\"'+\-.]",
        "the values of 'set var' are sets: write '{ { … } }', or use 'var' if each scenario has a single value",
        "{",
    ),
    NearMiss(
        rf"\bset\s+var\s*<\s*{_NAME}(?:\.{_NAME})*\s*>\s*:\s*\{{?\s*\Z",
        r"(?:(?:obj|ws|agn)\s+)?set\b",
        "the values of 'set var' are sets: write their elements, '{ { … } }', or 'select 2 combinations from <set>'",
    ),
    NearMiss(
        rf"(?<!set)\svar\s*<\s*{_NAME}(?:\.{_NAME})*\s*>\s*:\s*\{{\s*\Z",
        r"(?:(?:obj|ws|agn)\s+)?set\b(?=\s*<)",
        "all elements of a set are written without braces: 'var <…>: set <set>'",
    ),
    NearMiss(
        rf"(?<!set)\svar\s*<\s*{_NAME}(?:\.{_NAME})*\s*>\s*:\s*\Z",
        rf"<\s*{_NAME}(?:\.{_NAME})*\s*>",
        "write '{ <element>, … }' for single values, or 'set <set>' for all elements of a set",
        "{",
    ),
    NearMiss(
        r"(?<![\w\-])(?:obj|agn)\s+\Z", r"<", "a scene lists sets: write 'obj set <set>' or 'agn set <set>'", "set"
    ),
    NearMiss(
        r"(?<![\w\-])ws\s+\Z",
        r"<",
        "a scene lists sets and compositions: write 'ws set <set>' or 'ws comp <comp>'",
        "set",
    ),
    NearMiss(
        rf"(?<!set)\s(?P<var>var)\s*<\s*{_NAME}(?:\.{_NAME})*\s*>\s*:\s*\{{\s*\Z",
        r"\{",
        "'var' takes one value in each scenario: use 'set var' for a variable whose value is a set",
        rewrite=_as_set,
    ),
    NearMiss(
        r"\bat\s+some\s+time\s+\Z",
        r"within\b",
        "'within … seconds after' already means at some time: leave out 'at some time'",
        rewrite=_without_words,
    ),
    NearMiss(r"\bvar\s+\Z", _NAME, "variables are declared before 'Given:': move it there", ":"),
    NearMiss(r"\bset\s+\Z", r"var\b", "variables are declared before 'Given:': move it there", ":"),
    NearMiss(r"\bnot\s+\Z", _NAME, "'not' and its clause need parentheses: '( not name: holds(…) )'", ":"),
    NearMiss(r"\bholds\s*\(\s*\Z", r"not\b", "'not' must come before the whole clause: '( not name: holds(…) )'"),
    NearMiss(r"\b(?:before|after)\s+\Z", r"(?:first|last)\b(?=\s*<)", "write 'the' before it", "the", "the {}".format),
    NearMiss(r"\b(?:before|after|from|until)\s+\Z", r"event\s+(?=<)", "leave out 'event' here", "<", lambda _: ""),
    NearMiss(
        r",\s*\Z",
        r"for\s+(?=[\d.<])",
        "leave out 'for': 'N seconds after' means throughout these seconds",
        "within",
        lambda _: "",
    ),
    NearMiss(r"", r"isCorrect\s*(?=\(\s*<)", _CORRECT, "<"),
    NearMiss(r"\bisCorrect\s*\Z", r"\((?=\s*<)", _CORRECT, ":"),
    NearMiss(r"", rf"(?!not\b|pred\b|holds\b){_NAME}\s*(?=\(\s*<)", _OWN_PREDICATE, "<"),
    NearMiss(rf"(?<![\w\-.<])(?!(?:Given|When|Then)\b){_NAME}\s*\Z", r"\((?=\s*<)", _OWN_PREDICATE, ":"),
    NearMiss(
        r"",
        rf"(?P<quote>[\"']){_NAME}(?:\.{_NAME})?(?P=quote)",
        "names must be in angle brackets, without quotes",
        "<",
        lambda quoted: f"<{quoted[1:-1]}>",
    ),
    NearMiss(r"", rf"(?!not\b|pred\b){_NAME}(?:\.{_NAME})*", "names must be in angle brackets", "<", "<{}>".format),
    NearMiss(r"\d\s*\Z", r"(?:s|sec|secs|second)\b", "write the unit as 'seconds'", "seconds", lambda _: "seconds"),
    NearMiss(r"", r";", "no line ends with ';': remove it", fix=lambda _: ""),
    NearMiss(r"", r"=", "write ':' instead of '='", ":", lambda _: ":"),
    NearMiss(rf"\bvar\s+{_NAME}\s*\Z", r":\s*[\w\-]+", "variables have no declared type: remove it", fix=lambda _: ""),
    NearMiss(rf"\bvar\s+{_NAME}\s*\Z", r",\s*", "each variable needs its own 'var'", fix=lambda _: "\n    var "),
    NearMiss(r"", r"#|/\*", "a comment starts with '//'"),
    NearMiss(r"\b(?:Scenario|Template|Story)\s*\Z", r":\s*", "no ':' is allowed before the name", fix=lambda _: " "),
)
"""Common mistakes. If several match, the first one is reported."""


_OTHER_FILES = (
    (re.compile(r"(?:similar\s+)?(?:obj|ws|agn)\s+set\b|comp\b|scene\b(?!\s+inst\b|\s*:)"), ".scene"),
    (re.compile(r"Scenario\s+Exec\b|bhv\s+impl\b|obs\s+(?:provider|policy)\b|observation\b|robot\s+log\b"), ".bddx"),
    (re.compile(r"scene\s+inst\b(?!\s*:)|distrib\b|ktree\b"), ".scenex"),
    (re.compile(r"Event\b|Task\b|Requirement\b|const\s+set\b|Scenario\s+Template\b|User\s+Story\b"), ".bdd"),
)
"""First words of declarations, and the kind of file that may contain them."""


def other_file(text: str, offset: int) -> str | None:
    """Return the message on a declaration that belongs in another kind of file; ``None`` if none begins here."""
    for begin, kind in _OTHER_FILES:
        match = begin.match(text, offset)
        if match is not None:
            imported = ", and import that file here" if kind == ".scene" else ""
            return f"'{' '.join(match[0].split())}' belongs in a {kind} file: move it there{imported}"
    return None


def near_miss(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the common mistake that explains an error, or ``None``."""
    head = text[max(0, rejected.offset - 200) : rejected.offset]
    for miss in _NEAR_MISSES:
        if miss.expected and miss.expected not in rejected.expected.literals:
            continue
        if miss.expected in ("<", ":") and miss.fix is not None and _may_be_anything(rejected):
            continue
        at = re.compile(miss.at).match(text, rejected.offset)
        before = re.search(miss.before, head)
        if at is None or before is None or not at[0]:
            continue
        return SyntaxFault(
            Span(at.start(), at.start() + len(at[0].rstrip())), miss.message, _fix(miss, before, at, head)
        )
    return None


def _fix(miss: NearMiss, before: re.Match[str], at: re.Match[str], head: str) -> SyntaxFix | None:
    if miss.fix is not None:
        return SyntaxFix(Span(at.start(), at.end()), miss.fix(at[0]))
    if miss.rewrite is not None:
        found = miss.rewrite(before)
        return SyntaxFix(found.span.shifted(at.start() - len(head)), found.text)
    return None


def _may_be_anything(rejected: Rejected) -> bool:
    """Return whether a place allows too many texts to be certain of the intended one."""
    return len(rejected.expected.literals - {"pred", "the", "every"}) > 2
