"""What the pages link to is there."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from kit import DOCS, ROOT, command_names
from robbdd_tools.catalog.registry import load_catalog

PAGES = sorted(DOCS.rglob("*.md"))
LINK = re.compile(r"\]\((?!\w+:)([^)#\s]+)(?:#[^)]*)?\)")
PROMISE = re.compile(r"`((?:client-vscode/test|tests)/[\w/.]+)(?:::(\w+))?`")
A_TEST = re.compile(r"^(?:async )?def test_", re.MULTILINE)
TEST = re.compile(r"\]\((\.\./tests/[^)]+\.py)\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_links_lead_to_files(page: Path) -> None:
    targets = LINK.findall(page.read_text(encoding="utf-8"))
    assert [target for target in targets if not (page.parent / target).exists()] == []


@pytest.mark.parametrize("page", [ROOT / "SECURITY.md", DOCS / "reliability.md"], ids=lambda page: page.name)
def test_a_promise_names_a_test_that_exists(page: Path) -> None:
    named = PROMISE.findall(page.read_text(encoding="utf-8"))
    assert len(named) > 5
    for file, test in named:
        assert (ROOT / file).exists(), file
        assert not test or f"def {test}(" in (ROOT / file).read_text(encoding="utf-8"), f"{file}::{test}"


def test_each_feature_that_is_compared_is_linked_to_a_file_of_tests() -> None:
    text = (DOCS / "editors.md").read_text(encoding="utf-8")
    table = [line for line in text[text.index("\n| feature |") :].splitlines() if line.startswith("|")]
    rows = table[2:]
    assert len(rows) > 20
    for row in rows:
        tests = TEST.findall(row)
        assert len(tests) == 1, row
        assert A_TEST.search((DOCS / tests[0]).read_text(encoding="utf-8")) is not None, row


def test_each_command_has_its_row() -> None:
    assert {"check", "run", "doctor"} <= command_names()
    table = (DOCS / "overview.md").read_text(encoding="utf-8")
    assert [command for command in command_names() if f"`robbdd {command}" not in table] == []


def test_the_page_on_simulation_has_each_predicate_and_robot() -> None:
    page = (DOCS / "simulation.md").read_text(encoding="utf-8")
    catalog = load_catalog()
    words = [re.sub(r"^<\w+>|<.*|[$#].*", "", one.phrase).strip() for one in catalog.predicates.values()]
    assert [word for word in words if f"\n| {word} |" not in page] == []
    robots = catalog.robots.values()
    assert [one.name for one in robots if not any(f"`{prefix}…`" in page for prefix in one.prefixes)] == []


def test_the_context_has_a_term_for_each_type_and_property_of_the_catalog() -> None:
    terms = json.loads((ROOT / "metamodels" / "context.jsonld").read_text(encoding="utf-8"))["@context"].values()
    known = {term if isinstance(term, str) else term["@id"] for term in terms}
    catalog = load_catalog()
    words = (*catalog.predicates.values(), *catalog.behaviours.values())
    used = {one.rdf_type for one in catalog.predicates.values()}
    used |= {name for one in catalog.behaviours.values() for name in one.rdf_types}
    assert used | {slot.property for word in words for slot in word.slots} <= known
