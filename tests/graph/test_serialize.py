"""Every format holds the whole graph, one graph has one text, and nothing is fetched."""

import json
import subprocess
import sys
from typing import Any, cast

import pytest
from rdflib import BNode, Graph, Literal, URIRef
from rdflib.compare import isomorphic
from rdflib.term import Node

from graph.models import EVERYTHING
from graph.statements import built
from kit import MODEL
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.serialize import FORMATS, UnreadableGraph, parse, serialize

NAMESPACES = {
    "t": "https://example.org/t/",
    "env": "https://example.org/env/",
    "bdd": "https://example.org/taken/",
    "other_names": "https://example.org/other/",
}


def normal(graph: Graph) -> list[str]:
    return serialize(graph, "nt").splitlines()


@pytest.mark.parametrize("form", FORMATS)
def test_a_graph_survives_every_format(form: str) -> None:
    graph = built(EVERYTHING).graph
    assert normal(parse(serialize(graph, form), form)) == normal(graph)


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("back", ["_:head", "_:one", "_:two"])
def test_a_list_that_leads_back_into_itself_survives_every_format(form: str, back: str) -> None:
    text = f"""@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
        <https://x/node> <https://x/items> _:head .
        _:head rdf:first 1; rdf:rest _:one .
        _:one rdf:first 2; rdf:rest _:two .
        _:two rdf:first 3; rdf:rest {back} ."""
    graph = parse(text, "ttl")
    assert isomorphic(parse(serialize(graph, form), form), graph)


def relabelled(node: Node) -> Node:
    return BNode(f"x{node}") if isinstance(node, BNode) else node


@pytest.mark.parametrize("form", FORMATS)
def test_equal_graphs_give_equal_bytes_whatever_their_order_and_labels(form: str) -> None:
    graph = built(EVERYTHING).graph
    turned = Graph()
    for subject, predicate, value in sorted(graph, reverse=True):
        turned.add((relabelled(subject), predicate, relabelled(value)))
    assert serialize(turned, form) == serialize(graph, form)


@pytest.mark.parametrize("form", FORMATS)
def test_reading_back_gives_the_same_bytes(form: str) -> None:
    text = serialize(built(EVERYTHING).graph, form)
    assert serialize(parse(text, form), form) == text


@pytest.mark.parametrize("form", FORMATS)
def test_hash_seeds_do_not_show(form: str) -> None:
    script = (
        "import sys; sys.path[:0] = ['tests', 'server']\n"
        "from graph.models import EVERYTHING; from graph.statements import built\n"
        "from robbdd_tools.graph.rdf.serialize import serialize\n"
        f"sys.stdout.buffer.write(serialize(built(EVERYTHING).graph, {form!r}).encode())"
    )
    texts = {
        subprocess.run(
            [sys.executable, "-c", script], env={"PYTHONHASHSEED": seed}, capture_output=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert texts == {serialize(built(EVERYTHING).graph, form).encode()}


@pytest.mark.parametrize("form", ["ttl", "json-ld"])
def test_all_prefixes_are_bound_and_the_users_come_first(form: str) -> None:
    bound = {
        name: str(namespace) for name, namespace in parse(serialize(built(EVERYTHING).graph, form), form).namespaces()
    }
    assert {name: bound[name] for name in NAMESPACES} == NAMESPACES
    assert bound["bdd-2"] == PREFIXES["bdd"]
    assert bound["env-2"] == PREFIXES["env"]
    assert set(PREFIXES.values()) <= set(bound.values()) if form == "json-ld" else PREFIXES["time"] in bound.values()
    assert "_low" not in bound


def test_json_ld_is_one_readable_document_per_story() -> None:
    (story,) = (node for node in json.loads(serialize(built(MODEL).graph, "json-ld"))["@graph"] if "role" in node)
    (variant,) = story["criteria-list"]
    template = variant["of-template"]
    assert template["@type"] == ["ScenarioTemplate", "DuringEventsConstraint", "TimeConstraint"]
    assert [clause["@id"] for clause in template["has-clause"]] == ["t:on-bench", "t:when-bhv-fetch.when", "t:in-tray"]
    assert template["has-clause"][0]["before-event"] == {"@id": "t:pick-start", "@type": "Event"}
    assert template["has-clause"][2]["after-event"] == "t:place-end"
    assert all("://" not in key for node in described(story) for key in node)


def test_every_node_is_described_once_and_what_belongs_to_no_story_follows() -> None:
    nodes = json.loads(serialize(built(EVERYTHING).graph, "json-ld"))["@graph"]
    assert [node["@id"] for node in nodes[:2]] == ["other_names:zz-first", "t:aa-second"]
    names = [node["@id"] for node in described(nodes)]
    assert {"t:fetch", "t:sort", "env:bench_scene"} <= {node["@id"] for node in described(nodes[0])}
    assert len(names) == len(set(names))
    assert "other_names:mixed" in [node["@id"] for node in nodes[2:]]


def test_a_graph_whose_blank_nodes_are_joined_stays_flat() -> None:
    graph = built(MODEL).graph
    blank, story = BNode(), URIRef("https://example.org/t/fetching")
    for term in ("owner", "sponsor"):
        graph.add((story, URIRef(f"https://example.org/{term}"), blank))
    graph.add((blank, URIRef("https://example.org/name"), Literal("Ada")))
    assert isomorphic(parse(serialize(graph, "json-ld"), "json-ld"), graph)


def test_expanded_json_ld_needs_no_context() -> None:
    nodes = json.loads(serialize(built(MODEL).graph, "json-ld-expanded"))
    story = next(node for node in nodes if node["@id"] == "https://example.org/t/fetching")
    assert story["@type"] == [f"{PREFIXES['bdd']}UserStory"]
    assert not [node for node in nodes if "@context" in node]


def described(value: Any) -> list[dict[str, Any]]:
    """Return all nodes inside a JSON value that have more than a name."""
    if isinstance(value, list):
        return [node for item in cast("list[Any]", value) for node in described(item)]
    if not isinstance(value, dict):
        return []
    node = cast("dict[str, Any]", value)
    inner = [found for item in node.values() for found in described(item)]
    return [node, *inner] if "@id" in node and len(node) > 1 else inner


def test_json_ld_uses_a_term_for_everything_that_the_language_can_say() -> None:
    nodes = described(json.loads(serialize(built(EVERYTHING).graph, "json-ld"))["@graph"])
    keys = {key for node in nodes for key in node}
    types = {kind for node in nodes for kind in _types(node)}
    assert len(nodes) > 50
    assert not [name for name in keys | types if ":" in name or "/" in name]


def _types(node: dict[str, Any]) -> list[str]:
    types = node.get("@type", [])
    return [types] if isinstance(types, str) else types


def test_a_prefix_named_like_a_term_of_the_context_wins() -> None:
    text = "ns rows = 'https://example.org/rows/'\nEvent (ns=rows) role\n" + MODEL.replace(
        "var <fetch.part>: obj set <parts>\n", ""
    )
    graph = built(text).graph
    written = serialize(graph, "json-ld")
    assert '"@id": "rows:role"' in written
    assert normal(parse(written, "json-ld")) == normal(graph)


def test_foreign_blank_nodes_are_kept_apart() -> None:
    graph = Graph()
    knows, name = URIRef("https://example.org/knows"), URIRef("https://example.org/name")
    one, two, loop = BNode(), BNode(), BNode()
    for person, text in ((one, "one"), (two, "two")):
        graph.add((person, name, Literal(text, lang="en")))
        graph.add((URIRef("https://example.org/me"), knows, person))
    graph.add((loop, knows, loop))
    for form in FORMATS:
        assert isomorphic(parse(serialize(graph, form), form), graph)


def test_a_context_on_the_network_is_refused_with_what_to_do() -> None:
    document = json.dumps({"@context": "https://example.org/context.json", "@id": "https://example.org/a"})
    with pytest.raises(UnreadableGraph, match="write the context into the document itself"):
        parse(document, "json-ld")


@pytest.mark.parametrize(("form", "text"), [("ttl", "a b"), ("json-ld", "{"), ("nt", "<a> <b>"), ("xml", "<a")])
def test_a_text_that_is_no_graph_is_refused_with_a_sentence(form: str, text: str) -> None:
    with pytest.raises(UnreadableGraph, match=f"not a graph in the format {form}"):
        parse(text, form)


def test_an_unknown_format_names_the_known_ones() -> None:
    with pytest.raises(
        ValueError, match="'n3' is not a graph format; there are ttl, json-ld, json-ld-expanded, nt, xml"
    ):
        serialize(Graph(), "n3")
