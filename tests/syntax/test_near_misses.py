"""Common mistakes of newcomers have a message with the correct form, and a fix if it is certain."""

from __future__ import annotations

import pytest

from checks.models import LINES, SETS, fixed, found, story
from kit import MODEL
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.syntax.parse import parse_declaration

IN_TRAY = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
SINGLE = story(f"{LINES}                set var <fetch.goals>: {{ <places.bench_ws>, <places.tray_ws> }}\n", SETS)
STORED = "Predicate (ns=t) <x> is-stored at <y>: ( <x> is located at <y> and <x> is at rest )\n"
DOUBLE = MODEL.replace("var <fetch.part>: obj set <parts>", "var <fetch.part>: { { <parts.bolt> }, { <parts.nut> } }")


def errors(text: str) -> list[Diagnostic]:
    return [one for one in found(text) if one.severity is Severity.ERROR]


def changed(old: str, new: str) -> str:
    assert MODEL.count(old) >= 1
    return MODEL.replace(old, new, 1)


@pytest.mark.parametrize(
    ("text", "blamed", "words"),
    [
        (
            SINGLE,
            "<",
            "the values of 'set var' are sets: write '{ { … } }', or use 'var' if each scenario has a single value",
        ),
        (
            SINGLE.replace("<fetch.goals>: { <places.bench_ws>, <places.tray_ws> }", "<fetch.goals>: { set <spots> }"),
            "set",
            "the values of 'set var' are sets: write their elements, '{ { … } }', or 'select",
        ),
        (
            SINGLE.replace("<fetch.goals>: { <places.bench_ws>, <places.tray_ws> }", "<fetch.goals>: ws set <places>"),
            "ws set",
            "the values of 'set var' are sets: write their elements",
        ),
        (
            changed("<fetch.part>: obj set <parts>", "<fetch.part>: { obj set <parts> }"),
            "obj set",
            "all elements of a set are written without braces: 'var <…>: set <set>'",
        ),
        (
            f"{STORED.replace('( ', '').replace(' )', '')}{MODEL}",
            "and",
            "a definition with 'and' needs parentheses around all of it: '( … and … )'",
        ),
        (f"{MODEL}task (ns=t) other\n", "task", "a declaration begins with a capital letter: 'Task'"),
        (DOUBLE, "{", "'var' takes one value in each scenario: use 'set var'"),
        (
            changed(IN_TRAY, f"{IN_TRAY}\n        and held: holds(<part> is held by <robot>, after <place-end>)"),
            "and",
            "clauses joined by 'and' need parentheses",
        ),
        (changed("in-tray: holds", "not in-tray: holds"), "in-tray", "'not' and its clause need parentheses"),
        (
            changed("on-bench: holds(<part>", "on-bench: holds(not <part>"),
            "not",
            "'not' must come before the whole clause",
        ),
        (changed("<robot> picks <part>", "robot picks <part>"), "robot", "names must be in angle brackets"),
        (changed("after <place-end>", "after place-end"), "place-end", "names must be in angle brackets"),
        (changed("after <place-end>", "after last <place-end>"), "last", "write 'the' before it"),
        (changed("after <place-end>", "after event <place-end>"), "event", "leave out 'event' here"),
        (
            changed("0.5 seconds after", "at some time within 0.5 seconds after"),
            "within",
            "'within … seconds after' already means at some time: leave out 'at some time'",
        ),
        (changed("0.5 seconds after", "0.5 s after"), "s", "write the unit as 'seconds'"),
        (changed("task: <task>", "task: <task>;"), ";", "no line ends with ';'"),
        (changed("task: <task>", "task = <task>"), "=", "write ':' instead of '='"),
        (changed("    var part\n", "    var part: object\n"), ": object", "variables have no declared type"),
        (
            changed(IN_TRAY, "quick: holds(takes less than 5 s, from <pick-start> until <place-end>)"),
            "takes",
            "a duration is required by 'it takes less than 12 s",
        ),
        (changed("    var part\n", "    # the part\n    var part\n"), "#", "a comment starts with '//'"),
        (changed("    var part\n", "    /* the part */\n    var part\n"), "/*", "a comment starts with '//'"),
        (changed("Scenario bench-to-tray", "Scenario: bench-to-tray"), ":", "no ':' is allowed before the name"),
        (
            changed(IN_TRAY, "in-tray: holds(isCorrect(<goal>), after <place-end>)"),
            "isCorrect",
            "the language has no such predicate: write '<workspace> is correct for <object>'",
        ),
        (
            changed(IN_TRAY, "isCorrect(<goal>) after <place-end>"),
            "(",
            "the language has no such predicate: write '<workspace> is correct for <object>'",
        ),
        (
            changed(IN_TRAY, "in-tray: holds(isTidy(<goal>), after <place-end>)"),
            "isTidy",
            "the language has no such predicate: write 'pred(",
        ),
        (
            changed(IN_TRAY, "isTidy(<goal>) after <place-end>"),
            "(",
            "the language has no such predicate: write 'pred(",
        ),
        (changed(IN_TRAY, f"{IN_TRAY}\n    var late"), "late", "variables are declared before 'Given:'"),
        (changed(IN_TRAY, f"{IN_TRAY}\n    set var late"), "var", "variables are declared before 'Given:'"),
        (
            f"{MODEL}obj set (ns=t) more {{ object peg }}\n",
            "obj",
            "'obj set' belongs in a .scene file: move it there, and",
        ),
        (f'{MODEL}bhv impl (ns=t) own {{ catalog "pick" }}\n', "bhv", "'bhv impl' belongs in a .bddx file: move it"),
        (f"{MODEL}scene inst (ns=t) own {{ }}\n", "scene", "'scene inst' belongs in a .scenex file: move it there"),
    ],
)
def test_a_near_miss_is_one_error_that_says_what_to_write(text: str, blamed: str, words: str) -> None:
    (error,) = errors(text)
    assert error.code == "syntax"
    assert error.message.startswith(words)
    assert text[error.span.start : error.span.end] == blamed


@pytest.mark.parametrize(
    "text",
    [
        changed("<robot> picks <part>", "robot picks <part>"),
        changed("after <place-end>", "after place-end"),
        changed("after <place-end>", "after event <place-end>"),
        changed("0.5 seconds after", "0.5 s after"),
        changed("task: <task>", "task: <task>;"),
        changed("    var part\n    var robot\n", "    var part, robot\n"),
        changed("    var part\n", "    var part: object\n"),
        changed("Scenario bench-to-tray", "Scenario: bench-to-tray"),
        changed("Event (ns=t)", "event (ns=t)"),
    ],
)
def test_a_near_miss_with_a_certain_fix_is_fixed(text: str) -> None:
    assert fixed(text, "syntax") == MODEL


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("obj <parts.bolt>", "a scene lists sets: write 'obj set <set>' or 'agn set <set>'"),
        ("agn <arms.panda>", "a scene lists sets: write 'obj set <set>' or 'agn set <set>'"),
        ("ws <places.tray>", "a scene lists sets and compositions: write 'ws set <set>' or 'ws comp <comp>'"),
    ],
)
def test_a_single_element_in_a_scene_is_explained(entry: str, words: str) -> None:
    text = f"scene (ns=t) cell {{ {entry} }}"
    fault = parse_declaration("scene", text).faults[0]
    assert fault.message == words
    assert text[fault.span.start] == "<"


def test_at_some_time_before_within_is_removed() -> None:
    within = MODEL.replace("0.5 seconds after", "within 0.5 seconds after", 1)
    assert fixed(within.replace("within 0.5", "at some time within 0.5", 1), "syntax") == within


def test_a_set_given_to_a_var_is_fixed_by_set_var() -> None:
    (fix,) = errors(DOUBLE)[0].fixes
    (edit,) = fix.edits
    assert fix.title == "Insert 'set'"
    written = DOUBLE[: edit.span.start] + edit.text + DOUBLE[edit.span.end :]
    assert written == DOUBLE.replace("var <fetch.part>", "set var <fetch.part>")
