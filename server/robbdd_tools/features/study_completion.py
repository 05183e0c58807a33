"""Completion in a study: settings, forms of their values, and names that its models declare."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.features.quoted_completion import files_in_quotes
from robbdd_tools.features.studies import implementations_of_study, scenarios_of_study, variables_of_study
from robbdd_tools.features.study_words import WHOLE
from robbdd_tools.syntax.study_content import ALL, COVERABLE, DESIGNS, FAILURES
from robbdd_tools.syntax.study_text import REDUCING, SETTINGS
from robbdd_tools.syntax.study_tokens import Token, study_tokens

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_TYPED = re.compile(r"""(?P<quote>["'])(?P<text>[^"'\n]*)$|(?P<open><)[^<>\n]*$|(?P<word>[^\W\d][\w-]*)$""")
_COMMENT = re.compile(r"""(?:[^"'<\n/]|"[^"\n]*"|'[^'\n]*'|<[^<>\n]*>|<|/(?!/))*//""")
_FORMS = {
    **{name: f"{name}: " for name in SETTINGS},
    "scenarios": "scenarios: { ",
    "where": 'where: "',
    "factor": "factor ",
    "cover": "cover: { ",
}
"""Setting → the text that its proposal inserts."""
_SCENARIO, _IMPLEMENTATION, _VARIABLE, _BEHAVIOUR, _MODEL, _SCENE = (
    "a scenario",
    "an implementation",
    "a variable",
    "a behaviour",
    "a model",
    "a scene",
)
"""Expected values that are names or files. All other expected texts are words of the language."""

_CHOICES: Mapping[str, Sequence[str]] = {
    "design": DESIGNS,
    "traces": (FAILURES, ALL),
    "block": ("repetition",),
}
"""Setting → the words that begin its value."""
_LENGTHS = {"timeout": 3, "design": 3, "traces": 4}
"""Setting → the number of tokens of its colon and value, if the value has more than one token."""
_UNITS = {"timeout": "seconds", "traces": "MB"}


@dataclass(frozen=True, slots=True)
class _Cursor:
    """The word at a cursor, and the tokens before it.

    ``span`` is the typed part of the word, and ``whole`` the word. ``bracket`` is ``<`` inside of a
    reference, or the quote inside of a text.
    """

    tokens: Sequence[Token]
    span: Span
    whole: Span
    bracket: str


def complete_study(snapshot: Snapshot, uri: str, offset: int) -> list[Completion]:
    """Return the proposals at a cursor in a study."""
    document = snapshot.document(uri)
    line = document.text[document.text.rfind("\n", 0, offset) + 1 : offset]
    if _COMMENT.match(line):
        return []
    cursor = _cursor_in(document, offset, line)
    wanted = _expected(cursor.tokens)
    if cursor.bracket in ('"', "'"):
        return list(_files(uri, cursor, document, wanted))
    found: list[Completion] = []
    if cursor.bracket != "<":
        found += _words(cursor, [one for one in wanted if " " not in one])
    if _BEHAVIOUR in wanted and not cursor.bracket:
        found += (
            Completion(name, "catalog", "behaviour", name, cursor.span, cursor.whole)
            for name in sorted(set(load_catalog().behaviours) - set(_listed(cursor.tokens)))
        )
    if _SCENARIO in wanted:
        found += _names(document, cursor, scenarios_of_study(snapshot, uri), _listed(cursor.tokens))
    if _IMPLEMENTATION in wanted:
        listed = _listed(cursor.tokens) if _BEHAVIOUR in wanted else []
        found += _names(document, cursor, implementations_of_study(snapshot, uri), listed)
    if _VARIABLE in wanted:
        known = variables_of_study(snapshot, uri)
        local = {name: one for name, one in known.items() if "." not in name}
        found += _names(document, cursor, local, _ranged(cursor.tokens))
    return found


def _cursor_in(document: Document, offset: int, line: str) -> _Cursor:
    # An even number of quotes before the cursor closes all texts.
    quoted = re.sub(r"""\"[^"]*\"|'[^']*'""", lambda match: " " * len(match[0]), line)
    typed = _TYPED.search(quoted)
    start, bracket = offset, ""
    if typed is not None:
        bracket = typed["quote"] or typed["open"] or ""
        start = offset - len(typed[0]) + len(bracket)
    rest = re.compile(r"[^\"'\n]*" if bracket in ('"', "'") else r"[\w\-]*").match(document.text, offset)
    end = offset if rest is None else rest.end()
    tokens = [one for one in study_tokens(document.text[: start - len(bracket)]) if one.kind != "end"]
    return _Cursor(tokens, Span(start, offset), Span(start, end), bracket)


def _expected(tokens: Sequence[Token]) -> Sequence[str]:
    """Return the words and the kinds of values that may follow some tokens."""
    names = [one.text for one in tokens]
    if "Study" not in names:
        return (_MODEL,) if names[-1:] == ["import"] else ("import", "Study")
    inside = tokens[names.index("Study") + 1 :]
    if len(inside) < 2 or inside[1].text != "{":
        return ()
    begun = [place for place, one in enumerate(inside) if _begins(inside, place, one)]
    if not begun:
        return _settings(inside) if len(inside) == 2 else ()
    setting, given = inside[begun[-1]].text, [one.text for one in inside[begun[-1] + 1 :]]
    kinds = [one.kind for one in inside[begun[-1] + 1 :]]
    if setting == "factor" and given[:1] == ["var"]:
        return _range_value(inside, given, kinds)
    if setting == "cover":
        return _settings(inside) if given[-1:] == ["}"] else _goal_value(given, kinds)
    if setting in ("scenarios", "factor"):
        return _settings(inside) if given[-1:] == ["}"] else _list_value(setting, given)
    if setting == "stop":
        return _settings(inside) if kinds[-1:] == ["number"] and given[-2] != "rate" else _stop_value(given)
    if setting in _CHOICES and given == [":"]:
        return _CHOICES[setting]
    complete = len(given) == _LENGTHS.get(setting, 2)
    if complete:
        return _settings(inside)
    return (_UNITS[setting],) if setting in _UNITS and kinds[-1:] == ["number"] else ()


def _begins(tokens: Sequence[Token], place: int, one: Token) -> bool:
    """Return whether a token begins a setting. A catalog behaviour of the same name has no colon after it."""
    following = tokens[place + 1].text if place + 1 < len(tokens) else ""
    return one.kind == "name" and one.text in SETTINGS and (one.text == "factor" or following == ":")


def _settings(inside: Sequence[Token]) -> Sequence[str]:
    """Return the settings that a study may still have."""
    given = {one.text for place, one in enumerate(inside) if _begins(inside, place, one)} - {"factor"}
    reduced = set(REDUCING) if not given.isdisjoint(REDUCING) else set[str]()
    return [name for name in SETTINGS if name not in given | reduced]


def _list_value(setting: str, given: Sequence[str]) -> Sequence[str]:
    opened = given[-1:] in (["{"], [","])
    if setting == "scenarios":
        return (_SCENARIO,) if opened else ()
    if given in ([], ["bhv"]):
        return ("scene", "bhv", "var") if not given else (_IMPLEMENTATION,)
    if not opened:
        return ()
    return (_SCENE,) if given[0] == "scene" else (_BEHAVIOUR, _IMPLEMENTATION)


def _range_value(inside: Sequence[Token], given: Sequence[str], kinds: Sequence[str]) -> Sequence[str]:
    """Return the words and kinds of values that may follow a partly typed range. Its bounds may have units."""
    if len(given) == 1:
        return (_VARIABLE,)
    if kinds[1:] == ["reference", "sign"]:
        return ("from",)
    if "from" in given and "to" not in given:
        return ("to",) if "number" in kinds else ()
    return _settings(inside) if "to" in given and kinds.count("number") == 2 else ()


def _goal_value(given: Sequence[str], kinds: Sequence[str]) -> Sequence[str]:
    if given[-1:] in (["{"], [","]):
        return [kind for kind in COVERABLE if kind not in given]
    return ("%",) if kinds[-1:] == ["number"] else ()


def _stop_value(given: Sequence[str]) -> Sequence[str]:
    if list(given) == [":"]:
        return ("width", "rate")
    return ("against",) if len(given) == 3 and given[1] == "rate" else ()


def _listed(tokens: Sequence[Token]) -> list[str]:
    """Return the names in the list that is open at the end of some tokens."""
    opened = max((place for place, one in enumerate(tokens) if one.text == "{"), default=0)
    return [one.text.strip("<> ") for one in tokens[opened:] if one.kind in ("reference", "name")]


def _ranged(tokens: Sequence[Token]) -> list[str]:
    """Return the variables that have a range."""
    named = pairwise(tokens)
    return [name.text.strip("<> ") for word, name in named if word.text == "var" and name.kind == "reference"]


def _words(cursor: _Cursor, words: Sequence[str]) -> Iterator[Completion]:
    if "Study" in words and not cursor.tokens:
        yield Completion("Study …", "snippet", "whole study", WHOLE.body, cursor.span, cursor.whole)
    for word in words:
        text = _FORMS.get(word, 'import "' if word == "import" else f"{word} ")
        yield Completion(word, "keyword", "", text, cursor.span, cursor.whole)


def _names(
    document: Document, cursor: _Cursor, known: Mapping[str, Definition], listed: Sequence[str]
) -> Iterator[Completion]:
    """Yield names in angle brackets. Brackets that are already typed are not repeated."""
    closed = document.text.startswith(">", cursor.whole.end)
    for name, definition in sorted(known.items()):
        if name not in listed:
            text = f"{name}{'' if closed else '>'}" if cursor.bracket else f"<{name}>"
            origin = (definition.uri, definition.symbol.path)
            yield Completion(
                name, definition.kind, str(definition.kind), text, cursor.span, cursor.whole, 0, (), origin
            )


def _files(uri: str, cursor: _Cursor, document: Document, wanted: Sequence[str]) -> Iterator[Completion]:
    endings = {_MODEL: (".bdd", ".bddx"), _SCENE: (".scenex",)}
    if wanted and wanted[0] in endings:
        typed = document.text[cursor.span.start : cursor.span.end]
        for name, kind, last, target in files_in_quotes(uri, typed, frozenset(endings[wanted[0]])):
            span = Span(cursor.span.end - len(last), cursor.span.end)
            whole = Span(span.start, cursor.whole.end)
            yield Completion(name, kind, "", name, span, whole, origin=(target, ""))
