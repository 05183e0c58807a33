"""All errors of a file are found, each once, and the valid parts stay usable."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import pytest

from kit import MODEL, fixture
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.parse import parse_declaration

TEMPLATE = MODEL[MODEL.index("Scenario Template") : MODEL.index("User Story")]
STORY = MODEL[MODEL.index("User Story") :]


def faults(text: str) -> list[str]:
    return [text[fault.span.start : fault.span.end] for fault in parse_declaration("bdd", text).faults]


def mended(text: str) -> str:
    """Apply the fixes of the faults, from the last to the first."""
    for fault in reversed(parse_declaration("bdd", text).faults):
        assert fault.fix is not None, fault
        text = text[: fault.fix.span.start] + fault.fix.text + text[fault.fix.span.end :]
    return text


_WHEN, _THEN = TEMPLATE.index("    When:"), TEMPLATE.index("    Then:")
GIVEN = TEMPLATE[TEMPLATE.index("    Given:") : _WHEN]
WHEN, THEN = TEMPLATE[_WHEN:_THEN], TEMPLATE[_THEN:].removesuffix("}\n")
LOOP = "    for all ( var one in <parts> ) { When: <robot> picks <one> }\n"


@pytest.mark.parametrize(
    ("parts", "word", "message"),
    [
        (GIVEN + THEN, "Then", "'Then:' must come after 'When:' or 'for all'"),
        (GIVEN + THEN + LOOP, "Then", "'Then:' must come after 'When:' or 'for all'"),
        (WHEN + THEN + GIVEN, "Given", "'Given:' must come before 'When:' or 'for all'"),
        (GIVEN + GIVEN + WHEN, "Given", "'Given:' must come before 'When:' or 'for all'"),
        (GIVEN + WHEN + THEN + THEN, "Then", "'Then:' must come after 'When:' or 'for all'"),
        ("    When:\n" + LOOP, "When", "nothing is written between 'When:' and 'for all'"),
        ("    Given:\n" + WHEN, "Given", "nothing is written between 'Given:' and 'When'"),
        (
            "    When:\n" + "event <pick-start> occurs" + THEN,
            "Then",
            "'When:' needs a behaviour after its events: 'Beh",
        ),
        ("    When:\n" + "event <pick-start> occurs" + LOOP, "for", "'for all' is written instead of 'When:'"),
    ],
)
def test_a_part_of_a_scenario_that_is_out_of_order_is_told_its_place(parts: str, word: str, message: str) -> None:
    text = TEMPLATE.replace(GIVEN + WHEN + THEN, parts)
    first = parse_declaration("bdd", text).faults[0]
    assert text[first.span.start : first.span.end] == word
    assert first.message.startswith(message)


@pytest.mark.parametrize(
    "parts",
    [
        GIVEN + WHEN + THEN + LOOP,
        GIVEN + WHEN + LOOP + THEN,
        GIVEN + LOOP + WHEN + THEN,
        LOOP + LOOP + GIVEN + LOOP + THEN + GIVEN + WHEN,
        WHEN + "Then: holds(<part> is located at <goal>, after <pick-end>) Given: holds(<part> is held by <robot>, "
        "before <pick-end>) " + LOOP,
    ],
)
def test_parts_may_follow_each_other(parts: str) -> None:
    text = TEMPLATE.replace(GIVEN + WHEN + THEN, parts)
    assert parse_declaration("bdd", text).faults == ()


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("before <pick", "befor <pick", ["befor"]),
        ("var robot", "vr robot", ["vr"]),
        ("When:", "When", ["Behaviour"]),
        ("<robot> picks", "<robot picks", ["picks"]),
        ("task: <task>", "tsk: <task>", ["tsk"]),
        ("Then:", "Than:", ["Than"]),
    ],
)
def test_a_plain_mistake_has_a_fix_that_mends_it(old: str, new: str, found: list[str]) -> None:
    broken = TEMPLATE.replace(old, new, 1)
    assert faults(broken) == found
    assert faults(mended(broken)) == []


@pytest.mark.parametrize(("old", "found"), [("When:", ["Behaviour"]), ("Given:", ["on-bench"]), ("Then:", ["in-tray"])])
@pytest.mark.parametrize("comment", ["// it's {", '// "a', "// holds( // :\n// <b>"])
def test_a_missing_sign_is_put_before_a_comment(old: str, found: list[str], comment: str) -> None:
    broken = TEMPLATE.replace(old, f"{old[:-1]}  {comment}").replace("<goal>, ", f"<goal>, {comment}\n")
    assert faults(broken) == found
    assert faults(mended(broken)) == []


def test_several_mistakes_in_one_declaration_are_all_found() -> None:
    broken = TEMPLATE.replace("var robot", "vr robot").replace("before", "bfore").replace("When:", "When")
    broken = broken.replace("after", "aftr")
    assert faults(broken) == ["vr", "bfore", "Behaviour", "aftr"]
    assert mended(broken).split() == TEMPLATE.split()


def test_the_sound_parts_of_a_broken_declaration_keep_their_tree_and_names() -> None:
    declaration = parse_declaration("bdd", TEMPLATE.replace("var robot", "robot robot robot"))
    assert declaration.tree is not None
    paths = [symbol.path for symbol in declaration.symbols]
    assert paths == ["fetch", "fetch.part", "fetch.goal", "fetch.on-bench", "fetch.carry", "fetch.in-tray"]
    assert {reference.ref.path for reference in declaration.references} >= {"part", "goal", "pick-start"}


def test_a_name_in_a_broken_line_is_still_declared() -> None:
    declaration = parse_declaration("bdd", TEMPLATE.replace("var robot", "var robot !!"))
    assert "fetch.robot" in [symbol.path for symbol in declaration.symbols]


def test_a_missing_name_is_reported_once_and_invents_nothing() -> None:
    declaration = parse_declaration("bdd", STORY.replace("Scenario bench-to-tray", "Scenario"))
    assert [fault.message for fault in declaration.faults] == ["unexpected '{': expected a name"]
    assert [symbol.path for symbol in declaration.symbols] == ["fetching"]


def test_a_variable_with_a_type_is_still_declared() -> None:
    declaration = parse_declaration("bdd", TEMPLATE.replace("    var part\n", "    var part: object\n"))
    assert [fault.message for fault in declaration.faults] == ["variables have no declared type: remove it"]
    assert isinstance(declaration.tree, tree.Template)
    assert "part" in [variable.name.text for variable in declaration.tree.variables]


@pytest.mark.parametrize("value", ["<arms.panda>", "<parts>"])
def test_a_value_without_braces_is_one_error_and_still_a_value(value: str) -> None:
    text = STORY.replace("{ <arms.panda> }", value)
    declaration = parse_declaration("bdd", text)
    (fault,) = declaration.faults
    assert text[fault.span.start : fault.span.end] == value
    assert fault.message == "write '{ <element>, … }' for single values, or 'set <set>' for all elements of a set"
    assert isinstance(declaration.tree, tree.Story)
    variation = declaration.tree.variants[0].variation
    assert isinstance(variation, tree.Product)
    assert [one.variable.path for one in variation.assignments] == ["fetch.part", "fetch.robot", "fetch.goal"]


def test_one_broken_scenario_leaves_its_siblings() -> None:
    variant = STORY[STORY.index("        Scenario bench") : STORY.rindex("}")]
    second = variant.replace("bench-to-tray", "again").replace("scene: <bench_scene>", "scene <bench_scene>")
    third = variant.replace("bench-to-tray", "third")
    text = STORY.replace(variant, variant + second + third)
    declaration = parse_declaration("bdd", text)
    assert len(declaration.faults) == 1
    assert [symbol.path.split(".")[-1] for symbol in declaration.symbols] == [
        "fetching",
        "bench-to-tray",
        "again",
        "third",
    ]


Mistake = Callable[[str, random.Random], str | None]


def _without(sign: str) -> Mistake:
    return lambda line, _: line.replace(sign, "", 1) if sign in line else None


def _misspell(line: str, dice: random.Random) -> str | None:
    words = [match for match in re.finditer(r"(?<![\w<.-])[a-zA-Z]{4,}(?![\w>.-])", line) if match[0] in KEYWORDS]
    if not words:
        return None
    word = dice.choice(words)
    return f"{line[: word.start() + 1]}{line[word.start() + 2 :]}"


def _unknown(line: str, dice: random.Random) -> str | None:
    references = list(re.finditer(r"<[\w.-]+>", line))
    if not references:
        return None
    reference = dice.choice(references)
    return f"{line[: reference.end() - 1]}x{line[reference.end() - 1 :]}"


def _garbage(line: str, _: random.Random) -> str | None:
    return f"{line}\n    %% what is this" if line.strip().startswith("var ") else None


KEYWORDS = {
    "holds",
    "located",
    "before",
    "after",
    "until",
    "from",
    "task",
    "duration",
    "template",
    "scene",
    "variation",
}
MISTAKES: tuple[Mistake, ...] = (
    _without(")"),
    _without(">"),
    _without(":"),
    _without("}"),
    _misspell,
    _unknown,
    _garbage,
)


def _plant(text: str, dice: random.Random, count: int) -> tuple[str, list[int]]:
    """Make ``count`` mistakes on lines at least three apart; returns the text and the lines, from 0."""
    lines = text.split("\n")
    order = list(range(8, len(lines) - 1))
    dice.shuffle(order)
    planted: list[int] = []
    for number in order:
        if len(planted) == count or any(abs(number - other) < 3 for other in planted):
            continue
        mistakes = list(MISTAKES)
        dice.shuffle(mistakes)
        for mistake in mistakes:
            changed = mistake(lines[number], dice)
            if changed is not None:
                lines[number] = changed
                planted.append(number)
                break
    planted.sort()
    grown = [sum("\n" in lines[before] for before in range(line)) for line in planted]
    return "\n".join(lines), [line + more for line, more in zip(planted, grown, strict=True)]


def _lines(found: list[Diagnostic], text: str) -> list[int]:
    return [text.count("\n", 0, entry.span.start) for entry in found]


def test_a_missing_last_brace_is_reported_on_the_empty_line_where_it_would_stand() -> None:
    text = TEMPLATE[: TEMPLATE.rindex("}")] + "\n\n"
    (fault,) = parse_declaration("bdd", text).faults
    assert text[: fault.span.start].count("\n") == TEMPLATE.count("\n") - 1
    assert fault.span.start == fault.span.end


def test_of_ten_planted_errors_nearly_all_are_reported_with_hardly_a_follow_up() -> None:
    """An error counts as reported in its own line or the next, where a parser may notice missing text."""
    from tests.bench.models import model

    text = model(160)
    planted = reported = followed = 0
    for seed in range(60):
        broken, lines = _plant(text, random.Random(seed), 10)
        case = fixture(broken)
        analysis = case.snapshot.file(case.uri)
        assert analysis is not None
        places = _lines(list(analysis.diagnostics), broken)
        planted += len(lines)
        reported += sum(any(0 <= place - line <= 1 for place in places) for line in lines)
        followed += sum(not any(0 <= place - line <= 1 for line in lines) for place in places)
    assert planted == 600
    assert reported / planted >= 0.95, reported
    assert followed / planted <= 0.1, followed


@pytest.mark.parametrize("after", [", after <place-end>", " after <place-end>"])
def test_a_comma_before_whenever_is_removed(after: str) -> None:
    """In English, 'whenever' often has a comma before it."""
    clause = "holds(<part> is at rest, whenever <part> is held by <robot>"
    text = TEMPLATE.replace(THEN, f"    Then:\n        still: {clause}{after})\n")
    fault = parse_declaration("bdd", text).faults[0]
    assert fault.message.startswith("no comma comes before 'whenever'")
    assert fault.fix is not None
    assert text[: fault.fix.span.start].endswith("is at rest")
    assert text[fault.fix.span.end :].startswith(" whenever")
