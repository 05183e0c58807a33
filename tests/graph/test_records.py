"""Read access to a graph: its order, and the work for large lists."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest
from rdflib import Graph

from robbdd_tools.base.document import Document
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf import records as records_module
from robbdd_tools.graph.rdf.records import Records
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write import foreign
from robbdd_tools.graph.write.foreign import read_graph_file

PREFIX = f"@prefix : <http://example.org/> .\n@prefix bdd: <{PREFIXES['bdd']}> .\n"
ITEMS = 300
LIST = f"{PREFIX}:list :items ({' '.join(f':item-{number}' for number in range(ITEMS))}) .\n"


def count_calls(monkeypatch: pytest.MonkeyPatch, owner: Any, name: str, calls: Counter[str]) -> None:
    """Count the calls of a function or method."""
    wrapped = getattr(owner, name)

    def counted(*arguments: Any) -> Any:
        calls[name] += 1
        return wrapped(*arguments)

    monkeypatch.setattr(owner, name, counted)


def test_values_instances_and_subjects_are_in_alphabetical_order() -> None:
    text = f"{PREFIX}:b a bdd:UserStory ; bdd:elements :z, :y, 'text', :x .\n:a a bdd:UserStory ; bdd:elements :z .\n"
    records = Records(Graph().parse(data=text, format="turtle"))
    a, b = (f"http://example.org/{name}" for name in "ab")
    assert records.instances("bdd:UserStory") == (a, b)
    assert records.subjects("bdd:elements") == (a, b)
    assert [str(value).rpartition("/")[2] for value in records.all(b, "bdd:elements")] == ["text", "x", "y", "z"]


def test_no_value_of_a_list_is_sorted(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = Counter[str]()
    count_calls(monkeypatch, records_module, "sort_text", calls)
    Records(Graph().parse(data=LIST, format="turtle"))
    assert calls["sort_text"] == ITEMS + 1


def test_a_graph_file_is_indexed_once_for_all_its_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = Counter[str]()
    count_calls(monkeypatch, Records, "__init__", calls)
    count_calls(monkeypatch, foreign, "blank_owners", calls)
    validate(read_graph_file(Document("file:///list.ttl", 1, LIST)))
    assert calls == {"__init__": 1, "blank_owners": 1}
