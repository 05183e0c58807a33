"""Completion in clauses: forms only where they fit, fitting phrases first, joined clauses, literals."""

import re
from dataclasses import replace

import pytest

from kit import FOLDER, MODEL, SCENE, fixture
from robbdd_tools.base.document import Span
from robbdd_tools.catalog.executors import EXECUTORS
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.settings import SETTINGS, Setting
from robbdd_tools.checks.setting import may_have
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.features.part_snippets import PART_SNIPPETS
from robbdd_tools.names.uses import slot_kinds
from robbdd_tools.syntax.parse import parse_declaration

IN_TRAY = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
HELD = "held: holds(<part> is held by <robot>, after <pick-start>)"
SCENEX = "scene inst (ns=t) i {\n    scene: <s>\n%s\n}\n"
BODY = "Scenario Template (ns=t) fetch {\n    task: <task>\n    var part\n%s\n}\n"
THEN = BODY % "    When:\n        <robot> picks <part> and places at <goal>\n    Then:\n        %s"
STORY = 'User Story (ns=t) s {\n    As A "a" I Want "b" So That "c"\n    Scenarios:\n%s\n}\n'
VARIANT = STORY % "    Scenario v {\n        template: <t>\n        scene: <s>\n        variation:\n%s\n    }"
PLACES = {
    "name: holds(…)": ("bdd", THEN),
    "event name when …": ("bdd", BODY % "    %s\n    When:\n        <robot> picks <part> and places at <goal>"),
    "for all (…) { When: … Then: … }": ("bdd", BODY),
    "(var … exists in <…>) such that { … }": ("bdd", THEN),
    "(not …)": ("bdd", THEN),
    "(… and …)": ("bdd", THEN),
    "Scenario name { … }": ("bdd", STORY),
    "| <…> | <…> | table": ("bdd", VARIANT),
    "model name as … { … }": ("scenex", SCENEX % "    obj <o> {\n%s\n}"),
    "body name { frame … }": ("ktree", "ktree (ns=t) k {\n    root: <world>\n%s\n}\n"),
}
"""A place of each form."""


def at(text: str, name: str = "main.bdd") -> list[Completion]:
    case = fixture(f"//- {name}\n{text}")
    return complete(case.snapshot, FOLDER + name, case.cursor)


def edited(old: str, new: str) -> str:
    assert old in MODEL
    return MODEL.replace(old, new, 1)


def applied(text: str, entry: Completion) -> str:
    """The text after a proposal was chosen, with the first text of each placeholder."""
    inserted = re.sub(r"\$\{\d+(?::([^}]*)|\|([^,|]*)[^}]*)\}", lambda match: match[1] or match[2] or "", entry.text)
    edits = [(entry.span, inserted), *((edit.span, edit.text) for edit in entry.edits)]
    for span, new in sorted(edits, key=lambda one: -one[0].start):
        text = text[: span.start] + new + text[span.end :]
    return text


def places() -> list[tuple[str, str, str]]:
    return [(language, label, place) for label, (language, place) in PLACES.items()]


def test_each_form_has_a_place() -> None:
    assert {one.label for group in PART_SNIPPETS.values() for one in group} == set(PLACES)


@pytest.mark.parametrize(("language", "label", "place"), places(), ids=list(PLACES))
def test_a_form_is_offered_where_it_parses_and_nowhere_else(language: str, label: str, place: str) -> None:
    text = place % "$0"
    cursor = text.index("$0")
    (found,) = [one for one in at(text, f"main.{language}") if one.label == label]
    assert parse_declaration(language, applied(text.replace("$0", ""), found)).faults == ()
    elsewhere = [start for start in range(cursor - 1) if text[start].isspace()]
    for start in elsewhere:
        entries = at(text[:start] + " $0 " + text[start:cursor], f"main.{language}")
        for one in entries:
            if one.kind == "snippet" and one.detail == "form":
                whole = applied(text[:start] + "  ", one)
                assert not [
                    fault for fault in parse_declaration(language, whole).faults if "too early" not in fault.message
                ], whole


@pytest.mark.parametrize(
    "where", ["<part> $0, before <pick-start>)", "<part> is located at $0", "<part> is held by <robot>, $0"]
)
def test_no_declaration_is_offered_in_the_middle_of_a_clause(where: str) -> None:
    text = MODEL[: MODEL.index("<part> is located at")] + where
    assert [one.label for one in at(text) if one.label.endswith("…") or one.detail == "whole declaration"] == []


def leading(word: str) -> tuple[str, frozenset[str]] | None:
    """The words after the first slot of a predicate's phrase, and the kinds of that slot."""
    phrase = load_catalog().predicates[word].phrase
    match = re.match(r"<(\w+)> ([\w ]*\w)", phrase)
    return None if match is None else (match[2], slot_kinds(word)[match[1]])


@pytest.mark.parametrize(
    ("variable", "kind"), [("part", "object"), ("robot", "agent"), ("goal", "workspace")], ids=lambda one: one
)
def test_the_phrases_that_fit_the_variable_before_the_cursor_come_first(variable: str, kind: str) -> None:
    entries = at(edited(IN_TRAY, f"new: holds(<{variable}> $0"))
    ranks = {one.label: one.rank for one in entries if one.kind == "keyword"}
    begun = [one for word in load_catalog().predicates if (one := leading(word)) is not None]
    assert len(begun) >= 15
    for words, _ in begun:
        fits = any(kind in kinds for other, kinds in begun if other == words)
        assert (ranks[words] == 0) is fits, words
    assert set(ranks.values()) == {0, 1}


def test_values_tell_the_type_of_a_variable_that_no_phrase_uses_yet() -> None:
    text = MODEL.replace("    var part\n", "    var part\n    var other\n")
    text = text.replace("var <fetch.part>:", "var <fetch.other>: { <arms.ur10> }\n                var <fetch.part>:")
    ranks = {one.label: one.rank for one in at(text.replace(IN_TRAY, f"{IN_TRAY}\n        new: holds(<other> $0"))}
    assert (ranks["moves safely"], ranks["is located at"]) == (0, 1)


def test_every_phrase_is_as_good_as_another_for_a_variable_without_a_type() -> None:
    text = MODEL.replace("    var part\n", "    var part\n    var other\n").replace(IN_TRAY, "new: holds(<other> $0")
    assert {one.rank for one in at(text) if one.kind == "keyword"} == {0}


@pytest.mark.parametrize("joint", [" and ", " or ", "\n        and ", "\n        and // why\n        "])
@pytest.mark.parametrize("first", [IN_TRAY, "<part> is held by <robot> after <pick-start>", f"(not {IN_TRAY})"])
def test_clauses_are_offered_after_an_unparenthesised_and_with_its_parenthesis(first: str, joint: str) -> None:
    text = edited(IN_TRAY, f"{first}{joint}$0")
    start = text.index(first, text.index("Then:"))
    found = {one.label: one for one in at(text)}
    assert {"name: holds(…)", "holds", "part", "(not …)"} <= set(found)
    for one in found.values():
        assert [(edit.span, edit.text) for edit in one.edits] == [(Span(start, start), "(")], one.label
    chosen = applied(text.replace("$0", ""), found["name: holds(…)"])
    assert chosen.count("(") == chosen.count(")") + 1


@pytest.mark.parametrize("word", ["and", "or"])
def test_a_clause_may_be_continued_without_its_parenthesis(word: str) -> None:
    text = edited(IN_TRAY, f"{IN_TRAY}\n        $0")
    start = text.index(IN_TRAY)
    (found,) = [one for one in at(text) if one.label == word]
    assert [(edit.span, edit.text) for edit in found.edits] == [(Span(start, start), "(")]
    held = next(one for one in at(edited(IN_TRAY, f"( {IN_TRAY}\n        $0")) if one.label == word)
    assert held.edits == ()


def test_nothing_is_continued_before_the_first_clause() -> None:
    assert {"and", "or"}.isdisjoint(one.label for one in at(edited(IN_TRAY, "$0")))


@pytest.mark.parametrize("before", ["", f"{IN_TRAY}\n        and ", f"{IN_TRAY}\n        ", "( "])
def test_a_clause_may_be_negated_without_its_parenthesis(before: str) -> None:
    text = edited(IN_TRAY, f"{before}$0")
    (found,) = [one for one in at(text) if one.label == "not"]
    assert re.search(r"\(\s*not\b", applied(text.replace("$0", ""), found))
    begun = edited(IN_TRAY, f"{before}not $0")
    start = begun.index("$0")
    entries = {one.label: one for one in at(begun)}
    assert {"name: holds(…)", "holds", "part"} <= set(entries)
    opened = [(edit.span.start - start, edit.text) for edit in entries["holds"].edits]
    assert ((-len("not "), "(") in opened) is (before != "( ")


def test_a_fix_puts_a_negated_clause_into_parentheses() -> None:
    text = edited(IN_TRAY, f"not {IN_TRAY}")
    case = fixture(text)
    (error,) = [one for one in fast_diagnostics(case.snapshot, case.uri) if one.code == "syntax"]
    assert error.message == "'not' and its clause need parentheses: '( not name: holds(…) )'"
    ((edit,),) = [fix.edits for fix in error.fixes]
    assert text[: edit.span.start] + edit.text + text[edit.span.end :] == edited(IN_TRAY, f"(not {IN_TRAY})")


def test_an_empty_section_above_hides_no_proposals() -> None:
    given = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"
    text = edited(IN_TRAY, "$0")
    assert {one.label for one in at(text.replace(given, ""))} == {one.label for one in at(text)}


@pytest.mark.parametrize(("target", "kind"), [("robot", "agent"), ("part", "object"), ("arms.panda", "agent")])
def test_the_settings_that_fit_come_first(target: str, kind: str) -> None:
    ranks = {one.label: one.rank for one in at(edited(IN_TRAY, f"new: holds(<{target}> has config $0"))}
    assert ranks.keys() == SETTINGS.keys()
    assert {name for name, rank in ranks.items() if rank == 0} == {one for one in SETTINGS if may_have(kind, None, one)}
    assert 1 in ranks.values()


def test_variables_of_elements_come_last_where_a_quantity_is_written() -> None:
    text = edited(IN_TRAY, "new: holds(<robot> moves slower than $0").replace(
        "    var part\n", "    var part\n    var limit\n"
    )
    ranks = {one.label: one.rank for one in at(text) if one.kind == "variable"}
    assert ranks == {"limit": 0, "goal": 1, "part": 1, "robot": 1}


def test_a_scene_offers_sets_after_the_words_that_also_begin_a_declaration() -> None:
    for word, name in (("obj set", "parts"), ("agn set", "arms"), ("ws set", "places")):
        text = SCENE.replace("obj set <parts> ", f"\n    {word} $0\n    ")
        assert name in {one.label for one in at(text, "main.scene")}
        assert at(SCENE.replace("scene (ns=env)", f"{word} $0\nscene (ns=env)"), "main.scene") == []


def test_only_the_clauses_of_one_chain_are_joined() -> None:
    text = edited(IN_TRAY, f"{IN_TRAY}\n        {HELD} and other: $0")
    start = text.index(HELD)
    assert "holds" in {one.label for one in at(text)}
    assert {edit.span.start for one in at(text) for edit in one.edits} == {start}
    text = edited(IN_TRAY, f"{IN_TRAY} and {HELD}\n        third: holds(<part> $0")
    assert {one.label for one in at(text) if not one.edits} >= {"is located at"}


@pytest.mark.parametrize(
    "clauses",
    [
        f"{IN_TRAY} and {HELD}",
        f"{IN_TRAY} or\n            {HELD}",
        f"{IN_TRAY}\n        and {HELD}\n        and third: holds(<robot> moves safely, from <start> until <end>)",
        f"<part> is held by <robot> after <pick-start> and {HELD}",
        f"( not {IN_TRAY} ) and <part> is held by <robot> after <pick-start>",
        f"{IN_TRAY} // one\n        or {HELD} // two",
        f'"the part is clean" after <place-end> and {HELD}',
        f"(var y exists in <parts>) such that {{ holds(<y> is located at <goal>, after <end>) }} or {HELD}",
    ],
)
def test_a_fix_puts_joined_clauses_into_parentheses(clauses: str) -> None:
    text = edited(IN_TRAY, clauses)
    case = fixture(text)
    (error,) = [one for one in fast_diagnostics(case.snapshot, case.uri) if one.code == "syntax"]
    assert text[error.span.start : error.span.end] in ("and", "or")
    assert error.message.startswith(f"clauses joined by '{text[error.span.start : error.span.end]}' need parentheses")
    (fix,) = error.fixes
    assert fix.title == "Put the clauses into parentheses"
    (edit,) = fix.edits
    fixed = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert fixed.replace("(", "").replace(")", "") == text.replace("(", "").replace(")", "")
    case = fixture(fixed)
    assert [one.message for one in fast_diagnostics(case.snapshot, case.uri) if one.code == "syntax"] == []


def test_a_chain_of_and_and_or_is_not_fixed_because_its_order_is_unknown() -> None:
    text = edited(IN_TRAY, f"{IN_TRAY} and {HELD} or third: holds(<robot> moves safely, from <start> until <end>)")
    case = fixture(text)
    first = next(one for one in fast_diagnostics(case.snapshot, case.uri) if one.code == "syntax")
    assert (text[first.span.start : first.span.end], first.fixes) == ("and", ())


@pytest.mark.parametrize(
    "setting", [one for one in SETTINGS.values() if one.count == 1 or one.words], ids=lambda one: one.name
)
def test_the_values_of_a_setting_are_offered_for_its_variable(setting: Setting) -> None:
    text = MODEL.replace("    var part\n", "    var part\n    var amount\n")
    text = text.replace(
        IN_TRAY, f"{IN_TRAY}\n        new: holds(<part> has config {setting.name} = <amount>, before <start>)"
    )
    text = text.replace("var <fetch.part>:", "var <fetch.amount>: { $0 }\n                var <fetch.part>:")
    found = at(text)
    assert {one.label for one in found} == {"number", *(f'"{word}"' for word, _ in setting.words)}
    for one in found:
        if setting.count == 1 or one.label != "number":
            setting.read(applied("", Completion("", "", "", one.text, Span(0, 0), Span(0, 0))).strip('"'))


def test_units_of_what_is_measured_are_offered_after_a_number_and_whole_quantities_before() -> None:
    begun = "new: holds(<part> is tilted less than "
    assert [one.label for one in at(edited(IN_TRAY, f"{begun}10 $0")) if one.kind == "unit"] == ["rad", "deg"]
    assert [one.label for one in at(edited(IN_TRAY, f"{begun}10 d$0")) if one.kind == "unit"] == ["rad", "deg"]
    assert {"1 rad", "1 deg"} <= {one.label for one in at(edited(IN_TRAY, f"{begun}$0"))}
    text = MODEL.replace("    var part\n", "    var part\n    var limit\n")
    text = text.replace(
        IN_TRAY, f"{IN_TRAY}\n        new: holds(<robot> moves slower than <limit>, from <start> until <end>)"
    )
    row = "var <fetch.limit>: {{ {} }}\n                var <fetch.part>:"
    assert [one.label for one in at(text.replace("var <fetch.part>:", row.format("$0")))] == ["1 m/s"]
    assert [one.label for one in at(text.replace("var <fetch.part>:", row.format("0.3 $0")))] == ["m/s"]


def test_an_execution_offers_the_behaviours_of_the_catalog_in_quotes() -> None:
    found = {one.label: one.text for one in at("bhv impl (ns=x) b { catalog $0 }", "main.bddx")}
    assert found.keys() == {f'"{name}"' for name in EXECUTORS}
    assert all(label == text for label, text in found.items())


def test_a_further_behaviour_is_offered_after_a_behaviour() -> None:
    text = MODEL.replace("    Then:\n", "        $0\n    Then:\n", 1)
    assert {"then", "meanwhile"} <= {item.label for item in at(text)}


DEFINED = (
    "Predicate (ns=t) <one> is-put by <who> at <place>: ( <one> is located at <place> and <one> is held by <who> )\n"
    "Predicate (ns=t) free-space between <a> to <b>: ( <a> is nearer than 1 m to <b> )\n"
)


@pytest.mark.parametrize(
    ("before", "phrases"),
    [
        ("<part> ", ["is-put by <who> at <place>"]),
        ("<part> is-p", ["is-put by <who> at <place>"]),
        ("", ["free-space between <a> to <b>", "<one> is-put by <who> at <place>"]),
    ],
)
def test_the_whole_phrase_of_a_named_predicate_is_offered(before: str, phrases: list[str]) -> None:
    text = MODEL.replace("Scenario Template", f"{DEFINED}Scenario Template")
    text = text.replace(IN_TRAY, f"in-tray: holds({before}$0")
    found = [one for one in at(text) if one.detail == "phrase"]
    assert [one.label for one in found] == phrases
    for one in found:
        # With a time constraint and the end of the clause, the chosen phrase is a whole clause.
        typed = before.rpartition(" ")[2]
        head = f"in-tray: holds({before.removesuffix(typed)}"
        clause = applied(head, replace(one, span=Span(len(head), len(head))))
        assert parse_declaration("bdd", THEN % f"{clause}, after <end>)").faults == ()
