"""Read the text of a ``.study`` file.

::

    file    = { "import" text } "Study" name "{" { setting } "}"
    setting = "scenarios" ":" "{" "<" name ">" { "," "<" name ">" } "}"
            | "where" ":" text
            | ( "first" | "sample" | "pairwise" | "repeat" | "seed" | "batch" ) ":" whole number
            | "timeout" ":" number "seconds"
            | "stop" ":" ( "width" number | "rate" number "against" number )
            | "factor" "scene" ":" "{" text { "," text } "}"
            | "factor" "bhv" "<" name ">" ":" "{" name { "," name } "}"

The reader continues after an error with the next setting, so that all errors of a file are found at once.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span

_TOKEN = re.compile(
    r"""(?P<space>\s+|//[^\n\r]*)|(?P<text>"[^"\n\r]*"|'[^'\n\r]*')|(?P<reference><[^<>\n\r]*>)"""
    r"""|(?P<number>-?\d+(?:\.\d+)?(?![\w.]))|(?P<name>[^\W\d][\w-]*)|(?P<sign>[{}:,])|(?P<other>[^\s{}:,<>"']+|.)"""
)
STUDY = "study"
"""The ending of the names of studies, without the dot."""
MOST_REPETITIONS = 1_000_000
"""Limit of ``repeat``, ``first`` and ``sample``."""
MOST_BATCH = 10_000
"""Limit of ``batch``: the scenarios of a batch are in memory."""
MOST_SEED = 2**63 - 1
"""Limit of a seed: the results are stored in 64 bits."""
MOST_SECONDS = 1_000_000
"""Limit of ``timeout`` in s."""


@dataclass(frozen=True, slots=True)
class Word:
    """A value of a study, and its place in the text."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class Factor:
    """A factor of a study. ``implementation`` is the implementation of a behaviour; ``None`` for scene instances."""

    implementation: Word | None
    levels: tuple[Word, ...]


@dataclass(slots=True)
class StudyText:
    """The contents of a ``.study`` file. ``numbers`` has the settings with a number by their names."""

    imports: list[Word] = field(default_factory=list[Word])
    name: str = ""
    head: Span = field(default_factory=lambda: Span(0, 0))
    """The place of the name; empty if there is none."""
    scenarios: tuple[Word, ...] = ()
    where: Word | None = None
    factors: list[Factor] = field(default_factory=list[Factor])
    numbers: dict[str, float] = field(default_factory=dict[str, float])
    places: dict[str, Span] = field(default_factory=dict[str, Span])
    """The places of the names of settings."""

    @property
    def scenes(self) -> tuple[Word, ...]:
        """The files whose scene instances are levels of a factor."""
        return tuple(level for one in self.factors if one.implementation is None for level in one.levels)

    def whole(self, name: str) -> int | None:
        """Return a setting that is a whole number; ``None`` if it is missing."""
        found = self.numbers.get(name)
        return None if found is None else int(found)


class Token(NamedTuple):
    """A token of a study: white space and comments are left out, and the last one has the kind ``end``."""

    kind: str
    text: str
    span: Span


class _Unexpected(Exception):
    """The token does not belong here."""

    def __init__(self, token: Token, message: str) -> None:
        super().__init__(message)
        self.token = token


class _NumberRange(NamedTuple):
    least: int
    most: int
    is_whole: bool = True
    unit: str = ""


_NUMBERS: Mapping[str, _NumberRange] = {
    "first": _NumberRange(1, MOST_REPETITIONS),
    "sample": _NumberRange(1, MOST_REPETITIONS),
    "pairwise": _NumberRange(2, 3),
    "repeat": _NumberRange(1, MOST_REPETITIONS),
    "seed": _NumberRange(0, MOST_SEED),
    "batch": _NumberRange(1, MOST_BATCH),
    "timeout": _NumberRange(0, MOST_SECONDS, is_whole=False, unit="seconds"),
}
REDUCING = ("first", "sample", "pairwise")
"""Settings of which a study has at most one."""
SETTINGS = ("scenarios", "where", *_NUMBERS, "stop", "factor")
"""The words that begin a setting."""


def read_study(document: Document) -> tuple[StudyText, list[Diagnostic]]:
    """Return the contents of a study as far as they can be read, and the errors of its form."""
    reader = _Reader(document)
    return reader.read(), reader.faults


class _Reader:
    def __init__(self, document: Document) -> None:
        self._uri = document.uri
        self._tokens = list(study_tokens(document.text))
        self._next = 0
        self._found = StudyText()
        self.faults: list[Diagnostic] = []

    def read(self) -> StudyText:
        """Read the whole text."""
        try:
            while self._peek().text == "import":
                self._take()
                self._found.imports.append(self._text('the path of a model, such as "pick.bdd"'))
            self._expect("Study", "'import' or 'Study'")
            name = self._kind("name", "the name of the study")
            self._found.name, self._found.head = name.text, name.span
            self._expect("{")
        except _Unexpected as error:
            self._report(error)
            return self._found
        while self._peek().text != "}" and self._peek().kind != "end":
            try:
                self._setting()
            except _Unexpected as error:
                self._report(error)
                self._skip()
        try:
            self._expect("}")
            if self._peek().kind != "end":
                raise _Unexpected(self._peek(), "a file has one study: remove the text after it")
        except _Unexpected as error:
            self._report(error)
        return self._found

    def _setting(self) -> None:
        word = self._take()
        readers: Mapping[str, Callable[[], None]] = {
            "scenarios": self._scenarios,
            "where": self._where,
            "factor": self._factor,
            "stop": self._stop,
        }
        if word.text not in SETTINGS or word.kind != "name":
            raise _Unexpected(word, f"'{word.text}' is not a setting of a study{_meant(word.text)}")
        if word.text != "factor":
            self._refuse_twice(word)
            self._found.places[word.text] = word.span
        if word.text in readers:
            readers[word.text]()
        else:
            self._number(word.text)

    def _refuse_twice(self, word: Token) -> None:
        if word.text in self._found.places:
            raise _Unexpected(word, f"'{word.text}' is given twice: remove one of them")
        other = next((name for name in REDUCING if name in self._found.places), None)
        if word.text in REDUCING and other is not None:
            raise _Unexpected(word, f"give only one of '{other}' and '{word.text}'")

    def _scenarios(self) -> None:
        self._expect(":")
        self._found.scenarios = self._list(lambda: self._reference("a scenario or an execution, such as <normal>"))

    def _where(self) -> None:
        self._expect(":")
        self._found.where = self._text('a condition, such as "robot=panda"')

    def _factor(self) -> None:
        kind = self._take()
        if kind.text == "scene":
            self._expect(":")
            levels = self._list(lambda: self._text('a file with scene instances, such as "bench.scenex"'))
            self._add(kind, Factor(None, levels))
        elif kind.text == "bhv":
            implementation = self._reference("the implementation of a behaviour, such as <my-server>")
            self._expect(":")
            levels = self._list(lambda: _word(self._kind("name", "the name of a catalog behaviour")))
            self._add(kind, Factor(implementation, levels))
        else:
            raise _Unexpected(kind, "a factor is 'scene' or 'bhv': variables of scenarios vary in the model")

    def _add(self, place: Token, factor: Factor) -> None:
        names = [level.text for level in factor.levels]
        twice = next((level for number, level in enumerate(factor.levels) if level.text in names[:number]), None)
        if twice is not None:
            raise _Unexpected(Token("", "", twice.span), f"the level '{twice.text}' is given twice: remove one of them")
        own = factor.implementation and factor.implementation.text
        if any((one.implementation and one.implementation.text) == own for one in self._found.factors):
            raise _Unexpected(place, "this factor is given twice: write all of its levels into one list")
        self._found.factors.append(factor)

    def _number(self, name: str) -> None:
        self._expect(":")
        wanted = _NUMBERS[name]
        kind = "a whole number" if wanted.is_whole else "a number"
        form = f"{kind} from {wanted.least} to {wanted.most}"
        token = self._kind("number", form)
        value = float(token.text) if "." in token.text else int(token.text)
        if (wanted.is_whole and "." in token.text) or not wanted.least <= value <= wanted.most:
            raise _Unexpected(token, f"'{name}' is {form}, not {token.text}")
        if wanted.unit:
            self._expect(wanted.unit, f"the unit '{wanted.unit}'")
        self._found.numbers[name] = value

    def _stop(self) -> None:
        self._expect(":")
        rule = self._take()
        if rule.text == "width":
            self._found.numbers["stop width"] = self._share()
        elif rule.text == "rate":
            required = self._share()
            self._expect("against")
            place = self._peek()
            refused = self._share()
            if refused >= required:
                raise _Unexpected(place, f"the rate after 'against' has to be below {required:g}")
            self._found.numbers |= {"stop rate": required, "stop against": refused}
        else:
            raise _Unexpected(rule, "a study stops at 'width 0.05' or 'rate 0.95 against 0.9'")

    def _share(self) -> float:
        token = self._kind("number", "a number between 0 and 1")
        if not 0.0 < float(token.text) < 1.0:
            raise _Unexpected(token, f"expected a number between 0 and 1, not {token.text}")
        return float(token.text)

    def _list(self, one: Callable[[], Word]) -> tuple[Word, ...]:
        self._expect("{")
        words = [one()]
        while self._peek().text == ",":
            self._take()
            words.append(one())
        self._expect("}", "',' or '}'")
        return tuple(words)

    def _text(self, what: str) -> Word:
        token = self._kind("text", what)
        return Word(token.text[1:-1], Span(token.span.start + 1, token.span.end - 1))

    def _reference(self, what: str) -> Word:
        token = self._kind("reference", what)
        name = token.text[1:-1].strip()
        if not name:
            raise _Unexpected(token, f"expected {what}")
        return Word(name, token.span)

    def _kind(self, kind: str, what: str) -> Token:
        if self._peek().kind != kind:
            raise _Unexpected(self._peek(), f"expected {what}, not {_shown(self._peek())}")
        return self._take()

    def _expect(self, text: str, what: str = "") -> None:
        token = self._peek()
        if token.text != text or token.kind in ("text", "reference"):
            expected = what or f"'{text}'"
            raise _Unexpected(token, f"expected {expected}, not {_shown(token)}")
        self._take()

    def _peek(self) -> Token:
        return self._tokens[self._next]

    def _take(self) -> Token:
        token = self._peek()
        if token.kind != "end":
            self._next += 1
        return token

    def _skip(self) -> None:
        """Go to the next setting or to the end of the study. The brace of a list does not end the study."""
        while True:
            token = self._peek()
            following = self._tokens[min(self._next + 1, len(self._tokens) - 1)]
            begins = (
                token.kind == "name" and token.text in SETTINGS and (token.text == "factor" or following.text == ":")
            )
            closes = token.text == "}" and (following.kind == "end" or following.text == "Study")
            if token.kind == "end" or begins or closes:
                return
            self._take()

    def _report(self, error: _Unexpected) -> None:
        self.faults.append(Diagnostic(self._uri, error.token.span, Severity.ERROR, "syntax", str(error)))


def study_tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a study."""
    for match in _TOKEN.finditer(text):
        if match.lastgroup != "space":
            yield Token(match.lastgroup or "other", match.group(), Span(*match.span()))
    yield Token("end", "", Span(len(text), len(text)))


def _word(token: Token) -> Word:
    return Word(token.text, token.span)


def _shown(token: Token) -> str:
    return "the end of the file" if token.kind == "end" else f"'{token.text}'"


def _meant(text: str) -> str:
    near = difflib.get_close_matches(text, SETTINGS, 1)
    return f": did you mean '{near[0]}'?" if near else f": it has {', '.join(SETTINGS)}"
