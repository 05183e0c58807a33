"""Requirements that no scenario verifies, and the scenarios that do."""

import pytest

from checks.models import found
from kit import EVENTS, MODEL, STORY, TEMPLATE, fixture
from robbdd_tools.names.requirement_links import requirements_of, verifiers

NEED = 'Requirement (ns=t) R-1 { "The part is in the tray." source: "spec.pdf §4" }\n'
CLAUSE = TEMPLATE.replace("<place-end>)\n", "<place-end>) verifies <R-1>\n")
LINKED = {
    "clause": (CLAUSE, STORY),
    "template": (TEMPLATE.replace("    var", "    verifies: <R-1>\n    var", 1), STORY),
    "scenario": (TEMPLATE, STORY.replace("scene>\n", "scene>\n verifies: <R-1>\n")),
    "story": (TEMPLATE, STORY.replace("Scenarios:", "verifies: <R-1>\n    Scenarios:")),
}


def codes(text: str) -> list[str]:
    return [entry.code for entry in found(text) if entry.code != "unused-variable"]


def links(text: str) -> list[tuple[str, bool, list[str]]]:
    case = fixture(text)
    file = case.snapshot.file(next(uri for uri in case.project.texts() if uri.endswith("main.bdd")))
    assert file is not None
    return [
        (one.variant.definition.symbol.path, one.whole, sorted(clause.name for clause in one.clauses.values()))
        for several in verifiers(case.snapshot, requirements_of(file)).values()
        for one in several
    ]


def test_a_requirement_that_no_scenario_verifies_is_a_warning() -> None:
    assert codes(EVENTS + NEED + TEMPLATE + STORY) == ["unverified-requirement"]


@pytest.mark.parametrize("where", LINKED)
def test_each_link_leads_to_the_scenarios_and_clauses_that_verify(where: str) -> None:
    template, story = LINKED[where]
    assert (template, story) != (TEMPLATE, STORY)
    text = EVENTS + NEED + template + story
    assert codes(text) == []
    assert links(text) == [("fetching.bench-to-tray", where != "clause", ["in-tray"])]


def test_a_template_without_a_scenario_verifies_nothing() -> None:
    unused = CLAUSE.replace("(ns=t) fetch", "(ns=t) other", 1)
    assert "unverified-requirement" in codes(EVENTS + NEED + TEMPLATE + unused + STORY)


def test_a_file_of_requirements_alone_is_a_library_until_tests_import_it() -> None:
    needs = "ns t = 'https://example.org/t/'\n" + NEED
    assert "unverified-requirement" not in codes("//- main.bdd\n" + needs)
    tests = "//- tests.bdd\nimport 'main.bdd'\n" + MODEL.replace("(ns=t)", "(ns=u)").replace("ns t =", "ns u =")
    assert "unverified-requirement" in codes("//- main.bdd\n" + needs + tests)


def test_part_of_a_negation_does_not_verify_by_itself() -> None:
    template = CLAUSE.replace("in-tray:", "(not in-tray:").replace("verifies <R-1>\n", "verifies <R-1>)\n")
    ((_, whole, clauses),) = links(EVENTS + NEED + template + STORY)
    assert (whole, clauses) == (False, ["not"])
