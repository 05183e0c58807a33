"""Hover describes each keyword of each kind of file, with the text of the reference."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from features.test_every_prefix import OWN
from kit import DOCS, MODELS, STORY, fixture
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.describe_entry import describe_entry
from robbdd_tools.features.hover import hover
from robbdd_tools.features.study_words import FORMS, study_word_meaning
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.constructs import construct_of, constructs, literals, read_rules
from robbdd_tools.syntax.phrases import word_of_rule

GRAMMARS = ("bdd", "scene", "scenex", "bddx")
TOKEN = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|<[^<>\n]*>|(?P<word>[^\W\d][\w\-]*)|\S")
ANCHOR = re.compile(r"[^\w\- ]")


def keywords(language: str) -> list[tuple[str, str]]:
    """Each keyword of a grammar with its rule; the phrases of the catalog have texts of their own."""
    rules = read_rules(language).items()
    return [(rule, word) for rule, body in rules for word in literals(body) if word[0].isalpha()]


@pytest.mark.parametrize("language", GRAMMARS)
def test_each_keyword_of_each_rule_belongs_to_a_construct(language: str) -> None:
    found = keywords(language)
    assert len(found) > 20
    without = [one for one in found if word_of_rule(one[0]) is None and construct_of(language, *one) is None]
    assert without == [], "describe it in a section of grammar/reference"


@pytest.mark.parametrize("source", [*GRAMMARS, "base"])
def test_sections_name_rules_and_keywords_that_exist(source: str) -> None:
    for language in GRAMMARS if source == "base" else (source,):
        rules = read_rules(language)
        words = {word for _, word in keywords(language)}
        for construct in constructs(source):
            assert [rule for rule in construct.rules if rule not in rules] == []
            for word in construct.words:
                rule, _, inner = word.rpartition(".")
                assert inner in (literals(rules[rule]) if rule else words), word


@pytest.mark.parametrize("source", [*GRAMMARS, "base"])
def test_sections_lead_to_pages_that_exist(source: str) -> None:
    for construct in constructs(source):
        assert [code for code in construct.problems if not (DOCS / "diagnostics" / f"{code}.md").is_file()] == []
        page, _, anchor = construct.see.partition("#")
        if page:
            text = (DOCS / page).read_text(encoding="utf-8")
            titles = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
            assert not anchor or anchor in {ANCHOR.sub("", one.lower()).replace(" ", "-") for one in titles}, anchor


def described_everywhere(path: Path) -> int:
    """Check the hover at each keyword of a model, and return how many there are."""
    uri, language = path_to_uri(path), "scenex" if path.suffix == ".ktree" else path.suffix[1:]
    project = Project()
    project.load(uri)
    snapshot, text, number = project.snapshot(), path.read_text(encoding="utf-8"), 0
    every = dict.fromkeys(word for _, word in keywords(language))
    for match in TOKEN.finditer(text):
        if match["word"] in every and not text.startswith("=", match.end()):  # the name of a slot
            found = hover(snapshot, uri, match.start())
            assert found is not None, (path.name, text[match.start() - 20 : match.end()])
            number += 1
    return number


@pytest.mark.parametrize("path", [one for one in MODELS if one.suffix != ".study"], ids=lambda path: path.name)
def test_each_keyword_of_each_example_has_a_hover(path: Path) -> None:
    assert described_everywhere(path) > 5


def test_each_keyword_of_a_model_with_rare_constructs_has_a_hover(tmp_path: Path) -> None:
    for name, text in OWN.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert described_everywhere(tmp_path / "own.bdd") > 150


def at(text: str) -> str:
    case = fixture(f"//- main.bdd\n{text}")
    found = hover(case.snapshot, case.uri, case.cursor)
    return "" if found is None else found.markdown


def test_one_word_means_what_it_means_at_its_place() -> None:
    given, when = "x: holds(<p> is at rest, before <e>)", "event <e> occurs <r> picks <p>"
    template = f"Scenario Template (ns=t) a {{ var p var r Given: {given} When: {when} }}"
    assert "Acceptance criteria with variables" in at(template.replace("Scenario", "Scen$0ario"))
    assert "a template in a scene" in at(f"User Story (ns=t) s {{ {STORY_ROW.replace('Scenario', 'Scen$0ario')} }}")
    assert "What must be true before the work begins" in at(template.replace("Given", "Gi$0ven"))
    assert "The event must occur" in at(template.replace("event <", "eve$0nt <"))
    assert "An event of the template" in at(template.replace("Given", "ev$0ent near when <p> is at rest Given"))
    assert "a template in a scene" not in at(template.replace("var r ", "var r var scen$0e "))


STORY_ROW = "Scenario one { template: <a> scene: <s> variation: var <a.p>: { 1 } }"


@pytest.mark.parametrize("text", ["// Gi$0ven", 'Requirement (ns=t) r { "what is Gi$0ven" }', "Task (ns=t) Gi$0ven"])
def test_a_comment_a_text_and_a_name_are_no_keywords(text: str) -> None:
    assert "before the work begins" not in at(text)


def test_a_keyword_is_described_in_a_declaration_with_errors() -> None:
    broken = "Scenario Template (ns=t) a { var var x Giv$0en: x: holds(<p> is at rest, before <e>) "
    assert "before the work begins" in at(broken)


def test_the_words_before_the_scenarios_of_a_story_are_described() -> None:
    for word in ("User", "Story", "As", "Want", "So", "Scenarios"):
        text = f"ns t = 'https://t/'\n{STORY}"
        assert word in text
        assert "Who needs something and why" in at(text.replace(word, f"{word[0]}$0{word[1:]}", 1)), word


def test_the_particular_meaning_of_a_place_comes_before_the_general_one() -> None:
    clause = "x: holds(<p> is at rest, 2 seconds aft$0er <e>)"
    found = at(f"Scenario Template (ns=t) a {{ When: <r> picks <p> Then: {clause} }}")
    assert 0 <= found.index("Judged throughout the 2 s") < found.index("At the first sample at or after the event")


def test_each_word_of_a_setting_of_a_study_is_described() -> None:
    for name, (form, _) in FORMS.items():
        for line in form.splitlines():
            written = line if name in ("import", "Study") else f'import "a.bdd"\nStudy s {{\n{line}\n}}\n'
            for match in re.finditer(r"(?<![\w<\-\"])[a-z][a-z\-]+(?![\w.]*\")", line):
                project = Project()
                project.open("file:///f/a.study", 1, written)
                found = hover(project.snapshot(), "file:///f/a.study", written.index(line) + match.start())
                assert found is not None, (name, match[0])
                assert found.markdown == study_word_meaning(name), (name, match[0])


def test_a_proposed_keyword_of_one_construct_is_described_by_it() -> None:
    case = fixture("//- main.bdd\n$0")
    assert "at least one element" in str(describe_entry(case.snapshot, "keyword", case.uri, "exists in"))


def test_the_words_of_a_named_predicate_are_not_those_of_the_loop_around_it() -> None:
    loop = "for all (var x in <s>) { When: <r> picks <x> Then: holds(<x> is-stored $0in <b>, after <e>) }"
    found = at(f"Scenario Template (ns=t) a {{ set var s var b var r {loop} }}")
    assert "Defines a predicate from others" in found
    assert "Repeats its body" not in found
    loop = "for all (var x $0in <s>) { When: <r> picks <x> }"
    assert "Repeats its body" in at(f"Scenario Template (ns=t) a {{ set var s var r {loop} }}")
