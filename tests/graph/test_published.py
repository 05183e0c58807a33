"""JSON-LD as the metamodels' authors publish it: contexts by address, files that import one another, plain strings."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from checks.models import apply
from graph.test_foreign import FOREIGN
from kit import Fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.term_prefixes import METAMODELS
from robbdd_tools.graph.acceptance_model import Iri, Product, Table
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.foreign import read_graph_file
from robbdd_tools.names.project import Project

BDD = f"{METAMODELS}acceptance-criteria/bdd#"
X = "https://example.org/x/"


def read(path: Path) -> Any:
    return read_graph_file(Document(path_to_uri(path), 1, path.read_text(encoding="utf-8")))


def findings(path: Path) -> list[Diagnostic]:
    return validate(read(path))


def write(path: Path, *nodes: dict[str, Any], context: tuple[Any, ...]) -> Path:
    path.parent.mkdir(exist_ok=True, parents=True)
    document = {"@context": [*context, {"x": X}], "@graph": list(nodes)}
    path.write_text(json.dumps(document, indent=1), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "address",
    [
        "acceptance-criteria/bdd/bdd.json",
        "acceptance-criteria/bdd.json",
        "acceptance-criteria/bdd/environment.json",
        "time.json",
        "languages/python.json",
    ],
)
def test_contexts_of_the_published_metamodels_are_known_without_a_network(address: str, tmp_path: Path) -> None:
    clause = {"@id": "x:c", "@type": ["bdd:FluentClause"], "holds-at": "x:t", "ref-object": "x:o"}
    path = write(tmp_path / "m.json", clause, context=(METAMODELS + address,))
    built = read(path)
    assert built.faults == ()
    assert {(str(s), str(p), str(o)) for s, p, o in built.graph} == {
        (f"{X}c", "http://www.w3.org/1999/02/22-rdf-syntax-ns#type", f"{BDD}FluentClause"),
        (f"{X}c", f"{BDD}holds-at", f"{X}t"),
        (f"{X}c", f"{BDD}ref-object", f"{X}o"),
    }


def test_another_address_of_the_metamodels_is_not_made_up(tmp_path: Path) -> None:
    (fault,) = read(write(tmp_path / "m.json", context=(f"{METAMODELS}geometry/nothing.json",))).faults
    assert "is not fetched" in fault.message


@pytest.mark.parametrize("place", ["bdd.json", "bdd/bdd.json", "metamodels/acceptance-criteria/bdd/bdd.json"])
def test_a_file_beside_the_model_takes_the_place_of_an_address_that_ends_so(place: str, tmp_path: Path) -> None:
    own = tmp_path / place
    own.parent.mkdir(exist_ok=True, parents=True)
    own.write_text(json.dumps({"@context": {"holds-at": f"{X}own"}}), encoding="utf-8")
    address = f"{METAMODELS}acceptance-criteria/bdd/bdd.json"
    graph = read(write(tmp_path / "m.json", {"@id": "x:c", "holds-at": "now"}, context=(address,))).graph
    assert [str(predicate) for predicate in graph.predicates()] == [f"{X}own"]


def test_a_model_with_the_name_of_a_published_context_does_not_replace_it(tmp_path: Path) -> None:
    address = f"{METAMODELS}acceptance-criteria/bdd/environment.json"
    path = write(tmp_path / "environment.json", {"@id": "x:cup", "@type": "Object"}, context=(address,))
    built = read(path)
    assert built.faults == ()
    assert [str(kind) for kind in built.graph.objects()] == [f"{METAMODELS}environment#Object"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ('{"@context": {"a": 5}, "@id": "x:y"}', "@context property values must be strings or objects"),
        ('{"@context": {"a": "a:b"}, "@id": "x:y", "a": 1}', "Cyclical context definition detected (term a)"),
    ],
)
def test_an_error_in_json_ld_is_reported_with_its_cause(text: str, reason: str) -> None:
    (fault,) = read_graph_file(Document("file:///m.json", 1, text)).faults
    assert fault.message.endswith(reason)
    assert fault.message.startswith("this is not a graph in the format json-ld: ")


IMPORTS = "http://www.w3.org/2002/07/owl#imports"


def split(folder: Path, imported: str, name: str = "values.ttl") -> Path:
    """Write a sound model in two files, the second imported under some name; return the first."""
    head, tail = FOREIGN.split("ex:values a", 1)
    prefixes = head[: head.index("ex:begin")]
    path = folder / "model.ttl"
    path.write_text(f"{head}<> <{IMPORTS}> <{imported}> .\n", encoding="utf-8")
    (folder / name).parent.mkdir(exist_ok=True, parents=True)
    (folder / name).write_text(f"{prefixes}ex:values a{tail}", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("imported", "name"),
    [
        ("values.ttl", "values.ttl"),
        ("deeper/values.ttl", "deeper/values.ttl"),
        ("https://example.org/models/values.ttl", "values.ttl"),
        ("https://example.org/models/values.ttl", "models/values.ttl"),
    ],
)
def test_imported_files_are_one_model(imported: str, name: str, tmp_path: Path) -> None:
    path = split(tmp_path, imported, name)
    assert findings(path) == []
    assert len(read_model(read(path).graph).stories[0].variants) == 1


def test_files_may_import_each_other(tmp_path: Path) -> None:
    path = split(tmp_path, "values.ttl")
    other = tmp_path / "values.ttl"
    other.write_text(other.read_text(encoding="utf-8") + f"<> <{IMPORTS}> <model.ttl> .\n", encoding="utf-8")
    assert findings(path) == []
    assert findings(other) == []


@pytest.mark.parametrize(
    ("imported", "words"),
    [
        ("none.ttl", "there is no file 'none.ttl'"),
        (
            "https://example.org/none.ttl",
            "'https://example.org/none.ttl' is not fetched: put the file next to this one",
        ),
        ("notes.txt", "'notes.txt' is not a graph"),
        ("broken.ttl", "'broken.ttl' cannot be read"),
    ],
)
def test_an_import_that_cannot_be_used_is_an_error_at_the_import(imported: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("notes")
    (tmp_path / "broken.ttl").write_text("@prefix")
    path = split(tmp_path, imported, "other.ttl")
    fault = next(one for one in read(path).faults if one.code == "import")
    text = path.read_text(encoding="utf-8")
    assert (text[fault.span.start : fault.span.end], fault.severity) == (imported.rpartition("/")[2], Severity.ERROR)
    assert words in fault.message


def test_a_finding_in_an_imported_file_is_reported_there(tmp_path: Path) -> None:
    path = split(tmp_path, "values.ttl")
    other = tmp_path / "values.ttl"
    other.write_text(
        other.read_text(encoding="utf-8").replace("ex:cup ex:desk ex:arm", "ex:cup ex:desk"), encoding="utf-8"
    )
    assert {finding.uri for finding in findings(path)} == {path_to_uri(other)}


FOREIGN_NAMESPACE = """{
  "@context": { "bdd": "https://my.url/bdd#", "held-by": { "@id": "bdd:ref-agent", "@type": "@id" } },
  "@graph": [ { "@id": "https://my.url/c", "@type": ["bdd:FluentClause", "bdd:IsHeldPredicate"],
                "held-by": "https://my.url/bdd" } ]
}
"""


def test_an_unknown_namespace_with_terms_of_the_vocabulary_is_reported_with_the_one_that_is_meant() -> None:
    document = Document("file:///m.jsonld", 1, FOREIGN_NAMESPACE)
    (found,) = read_graph_file(document).faults
    assert (found.code, found.severity) == ("unknown-namespace", Severity.WARNING)
    assert found.message == (
        "the namespace <https://my.url/bdd#> is unknown, so its terms are ignored "
        f"('FluentClause', 'IsHeldPredicate', 'ref-agent'); did you mean <{BDD}>?"
    )
    assert document.text[found.span.start : found.span.end] == "https://my.url/bdd#"
    project = Project()
    project.open(document.uri, 1, document.text)
    apply(Fixture(project, document.uri, -1, ()), found.fixes[0])
    (_, text) = project.texts()[document.uri]
    assert "unknown-namespace" not in [one.code for one in read_graph_file(Document(document.uri, 2, text)).faults]


def test_a_namespace_of_the_users_own_is_no_finding() -> None:
    assert read_graph_file(Document("file:///m.ttl", 1, FOREIGN)).faults == ()


def test_a_message_says_what_stands_where_the_iri_of_a_node_is_expected() -> None:
    text = FOREIGN.replace("bdd:ref-object ex:thing", 'bdd:ref-object "thing"', 1)
    messages = [one.message for one in validate(read_graph_file(Document("file:///m.ttl", 1, text)))]
    assert any(
        one.startswith("'ex:there': 'thing' cannot stand for")
        and one.endswith("(it is text; the IRI of a node is expected)")
        for one in messages
    )
    text = FOREIGN.replace("bdd:ref-object ex:thing", "bdd:ref-object ex:nobody", 1)
    messages = [one.message for one in validate(read_graph_file(Document("file:///m.ttl", 1, text)))]
    assert any("'ex:nobody' cannot stand for" in one and "nothing in the graph describes it" in one for one in messages)


ONE = """ex:values a bdd:TaskVariation, bdd:CartesianProductVariation ; task:of-task ex:job ;
    bdd:variable-list ( ex:thing ex:place ex:who ) ; bdd:of-sets ( ex:one ( ex:desk ) ( ex:arm ) ) .
ex:cups a bdd:Set, bdd:ConstantSet ; bdd:elements ex:cup, ex:mug .
ex:mug a env:Object .
ex:one a bdd:Combination ; bdd:from ex:cups ; bdd:length 1 ; bdd:repetition-allowed "false" .
"""


def test_a_combination_of_one_gives_each_element_to_a_variable_that_is_no_set() -> None:
    text = FOREIGN[: FOREIGN.index("ex:values a")] + ONE
    built = read_graph_file(Document("file:///m.ttl", 1, text))
    assert [one for one in validate(built) if one.severity is Severity.ERROR] == []
    variation = read_model(built.graph).stories[0].variants[0].variation
    assert isinstance(variation, Product)
    first = variation.choices[0]
    assert isinstance(first, tuple)
    assert sorted(map(str, first)) == ["https://example.org/cell#cup", "https://example.org/cell#mug"]


def test_values_of_published_models_are_named_by_strings(tmp_path: Path) -> None:
    product = {
        "@id": "x:product",
        "@type": "bdd:CartesianProductVariation",
        "of-sets": [["x:table"], ["x:panda", "x:ur10"]],
    }
    address = f"{METAMODELS}acceptance-criteria/bdd/bdd.json"
    graph = read(write(tmp_path / "m.json", product, context=(address,))).graph
    assert "bdd:of-sets ( ( x:table ) ( x:panda x:ur10 ) )" in " ".join(serialize(graph, "ttl").split())
    assert parse(serialize(graph, "nt"), "nt")


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("fast", '"fast"'),
        ("as fast as possible", '"as fast as possible"'),
        ("10:30", '"10:30"'),
        ("x:cup", "x:cup"),
        ("https://example.org/x/cup", "x:cup"),
        ("cup", "<file:///models/cup>"),
        (2.5, "2.5e+00"),
    ],
)
def test_a_string_that_names_no_node_stays_a_string(value: str | float, expected: str) -> None:
    document = {
        "@context": [f"{METAMODELS}acceptance-criteria/bdd/bdd.json", {"x": X}],
        "@graph": [
            {"@id": "x:table", "@type": "bdd:TableVariation", "rows": [["x:panda", value]]},
            {"@id": "x:set", "@type": "bdd:Set", "elements": [value]},
            {"@id": "cup", "@type": "env:Object"},
        ],
    }
    graph = read_graph_file(Document("file:///models/m.json", 1, json.dumps(document))).graph
    text = " ".join(serialize(graph, "ttl").split())
    assert f"bdd:rows ( ( x:panda {expected} ) )" in text
    assert f"bdd:elements {expected}" in text


def test_names_below_a_stated_base_are_nodes_of_whatever_file() -> None:
    context = [f"{METAMODELS}acceptance-criteria/bdd/bdd.json", {"@base": "https://example.org/x/"}]
    document = {"@context": context, "@id": "values", "rows": [["cup"]]}
    graph = read_graph_file(Document("file:///models/m.json", 1, json.dumps(document))).graph
    assert "<https://example.org/x/cup>" in serialize(graph, "nt")


def test_a_string_value_reaches_the_scenarios(tmp_path: Path) -> None:
    text = FOREIGN.replace(
        "ex:who a bdd:ScenarioVariable .", "ex:who a bdd:ScenarioVariable . ex:how a bdd:ScenarioVariable ."
    )
    text = text.replace("( ex:thing ex:place ex:who )", "( ex:thing ex:place ex:who ex:how )")
    text = text.replace("( ex:cup ex:desk ex:arm )", '( ex:cup ex:desk ex:arm "as fast as possible" )')
    path = tmp_path / "m.ttl"
    path.write_text(text, encoding="utf-8")
    assert [one for one in findings(path) if one.severity is Severity.ERROR] == []
    variation = read_model(read(path).graph).stories[0].variants[0].variation
    assert isinstance(variation, Table)
    assert variation.rows[0][-1] == "as fast as possible"
    assert not isinstance(variation.rows[0][-1], Iri)


OLDER = """ex:there a bdd:FluentClause ; bdd:clause-of ex:t ; bdd:holds ex:at-place ; bdd:holds-at ex:when-done .
ex:at-place a bdd:LocatedAtPredicate ; bdd:ref-object ex:thing ; bdd:ref-workspace ex:place .
ex:when-done a rtime:TimeConstraint, rtime:AfterEventConstraint ; rtime:ref-event ex:done .
"""


@pytest.mark.parametrize("event", ["rtime:ref-event", "rtime:after-event"])
def test_clauses_with_predicate_and_time_on_nodes_of_their_own_are_clauses(event: str) -> None:
    begin = FOREIGN.index("ex:there a")
    newer = FOREIGN[begin : FOREIGN.index("\n\n", begin) + 1]
    text = FOREIGN.replace(newer, OLDER.replace("rtime:ref-event", event))
    built = read_graph_file(Document("file:///m.ttl", 1, text))
    assert [one.message for one in validate(built) if one.severity is Severity.ERROR] == []
    (older,), (expected,) = (
        [story.variants[0].template.clauses[1] for story in read_model(parsed).stories]
        for parsed in (built.graph, parse(FOREIGN, "ttl"))
    )
    assert older == expected


def test_a_missing_time_of_an_older_clause_is_reported_at_the_clause() -> None:
    begin = FOREIGN.index("ex:there a")
    newer = FOREIGN[begin : FOREIGN.index("\n\n", begin) + 1]
    text = FOREIGN.replace(newer, OLDER.replace("rtime:AfterEventConstraint ; rtime:ref-event ex:done", "ex:Nothing"))
    messages = [one.message for one in validate(read_graph_file(Document("file:///m.ttl", 1, text)))]
    assert any(message.startswith("'ex:there'") for message in messages), messages
