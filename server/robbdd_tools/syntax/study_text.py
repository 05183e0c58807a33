"""Read the text of a ``.study`` file, whose grammar is ``grammar/study.tx``.

The reader continues after an error with the next setting, so that all errors of a file are found at once.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.syntax.study_content import (
    ALL,
    COVERABLE,
    DESIGNS,
    FAILURES,
    MOST_POINTS,
    MOST_TRACES,
    SOBOL,
    Design,
    Factor,
    KeptTraces,
    Range,
    StudyText,
    Word,
)
from robbdd_tools.syntax.study_numbers import NUMBERS
from robbdd_tools.syntax.study_tokens import Token, study_tokens


class _Unexpected(Exception):
    """The token does not belong here."""

    def __init__(self, token: Token, message: str) -> None:
        super().__init__(message)
        self.token = token


REDUCING = ("first", "sample", "pairwise")
"""Settings that reduce the number of scenarios. A study may have only one of them."""
SETTINGS = ("scenarios", "where", *NUMBERS, "stop", "block", "traces", "design", "cover", "factor")
"""The words that begin a setting."""


def read_study(document: Document) -> tuple[StudyText, list[Diagnostic]]:
    """Return the readable contents of a study, and its syntax errors."""
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
            "design": self._design,
            "traces": self._traces,
            "block": self._block,
            "cover": self._cover,
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
            levels = self._list(self._behaviour)
            self._add(kind, Factor(implementation, levels))
        elif kind.text == "var":
            self._range()
        else:
            message = "a factor is 'scene', 'bhv' or 'var': other variables of scenarios vary in the model"
            raise _Unexpected(kind, message)

    def _behaviour(self) -> Word:
        wanted = "the name of a catalog behaviour, or of an implementation, such as <my-server-v2>"
        if self._peek().kind == "reference":
            return self._reference(wanted)
        token = self._kind("name", wanted)
        return Word(token.text, token.span)

    def _range(self) -> None:
        variable = self._reference("a variable of scenarios, such as <height>")
        self._expect(":")
        first = self._expect("from")
        low, low_unit = self._quantity()
        self._expect("to")
        high, high_unit = self._quantity()
        span = Span(first.span.start, self._tokens[self._next - 1].span.end)
        place = Token("", "", span)
        if low >= high:
            raise _Unexpected(place, f"a range goes from its lower to its upper bound, not from {low:g} to {high:g}")
        if low_unit and low_unit != high_unit:
            raise _Unexpected(place, f"both bounds have one unit: write '{low_unit}' after both of them")
        if any(one.variable.text == variable.text for one in self._found.ranges):
            raise _Unexpected(Token("", "", variable.span), "this variable has a range: remove one of them")
        self._found.ranges.append(Range(variable, low, high, high_unit, span))

    def _quantity(self) -> tuple[float, str]:
        """Read a number and its unit, if any. The name of the next setting is not a unit."""
        number = self._kind("number", "a number")
        unit = ""
        following = self._tokens[min(self._next + 1, len(self._tokens) - 1)]
        begins = self._peek().text in ("to", *SETTINGS) or following.text == ":"
        if self._peek().kind in ("name", "other") and not begins:
            last = self._take()
            unit = last.text
            while self._peek().kind in ("name", "other") and self._peek().span.start == last.span.end:
                last = self._take()
                unit += last.text
        return float(number.text), unit

    def _design(self) -> None:
        self._expect(":")
        kind = self._take()
        if kind.text not in DESIGNS:
            raise _Unexpected(kind, f"a design is {', '.join(DESIGNS)}, such as 'latin-hypercube 20'")
        token = self._kind("number", f"a whole number from 2 to {MOST_POINTS}")
        if "." in token.text or not 2 <= int(token.text) <= MOST_POINTS:
            raise _Unexpected(token, f"expected a whole number from 2 to {MOST_POINTS}, not {token.text}")
        size = int(token.text)
        if kind.text == SOBOL and size & (size - 1):
            below = 1 << (size.bit_length() - 1)
            raise _Unexpected(token, f"a Sobol design has a power of two of points: write {below} or {2 * below}")
        self._found.design = Design(kind.text, size, Span(kind.span.start, token.span.end))

    def _block(self) -> None:
        self._expect(":")
        self._expect("repetition", "'repetition': all executions of a repetition get the same seed")
        self._found.is_blocked = True

    def _traces(self) -> None:
        self._expect(":")
        kind = self._take()
        if kind.text not in (FAILURES, ALL):
            raise _Unexpected(kind, "a study keeps the traces of 'failures' or of 'all', such as 'failures 500 MB'")
        token = self._kind("number", f"a whole number from 1 to {MOST_TRACES}")
        if "." in token.text or not 1 <= int(token.text) <= MOST_TRACES:
            raise _Unexpected(token, f"expected a whole number from 1 to {MOST_TRACES}, not {token.text}")
        self._expect("MB", "the unit 'MB'")
        self._found.traces = KeptTraces(kind.text == FAILURES, int(token.text))

    def _cover(self) -> None:
        self._expect(":")
        self._list(self._goal)

    def _goal(self) -> Word:
        kind = self._take()
        if kind.text not in COVERABLE or kind.text in self._found.goals:
            raise _Unexpected(kind, f"a study covers {', '.join(COVERABLE)}, each once, such as 'pairs 90 %'")
        token = self._kind("number", "a number from 1 to 100")
        if not 1 <= float(token.text) <= 100:
            raise _Unexpected(token, f"expected a number from 1 to 100, not {token.text}")
        self._expect("%", "the unit '%'")
        self._found.goals[kind.text] = float(token.text)
        return Word(kind.text, kind.span)

    def _add(self, place: Token, factor: Factor) -> None:
        names = [level.words for level in factor.levels]
        twice = next((level for number, level in enumerate(factor.levels) if level.words in names[:number]), None)
        if twice is not None:
            raise _Unexpected(
                Token("", "", twice.span), f"the level '{twice.words}' is given twice: remove one of them"
            )
        own = factor.implementation and factor.implementation.text
        if any((one.implementation and one.implementation.text) == own for one in self._found.factors):
            raise _Unexpected(place, "this factor is given twice: write all of its levels into one list")
        self._found.factors.append(factor)

    def _number(self, name: str) -> None:
        self._expect(":")
        wanted = NUMBERS[name]
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
        return Word(name, token.span, is_name=True)

    def _kind(self, kind: str, what: str) -> Token:
        if self._peek().kind != kind:
            raise _Unexpected(self._peek(), f"expected {what}, not {self._peek().words}")
        return self._take()

    def _expect(self, text: str, what: str = "") -> Token:
        token = self._peek()
        if token.text != text or token.kind in ("text", "reference"):
            expected = what or f"'{text}'"
            raise _Unexpected(token, f"expected {expected}, not {token.words}")
        return self._take()

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


def _meant(text: str) -> str:
    near = difflib.get_close_matches(text, SETTINGS, 1)
    return f": did you mean '{near[0]}'?" if near else f": it has {', '.join(SETTINGS)}"
