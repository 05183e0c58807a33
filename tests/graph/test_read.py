"""A graph gives the acceptance criteria back, in written order, from every format, complete or not at all."""

import pytest
from rdflib import BNode, Graph, URIRef
from rdflib.namespace import RDF

from graph.models import EVERYTHING
from graph.statements import built
from kit import MODEL
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    Condition,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Iri,
    Junction,
    Product,
    Selection,
    Table,
    TextClause,
    TextFluent,
    Variant,
)
from robbdd_tools.graph.rdf.serialize import FORMATS, parse, serialize
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.monitor.time import After, Before, During

T, LAB, OTHER = "https://example.org/t/", "https://example.org/env/", "https://example.org/other/"


def model(text: str = EVERYTHING) -> AcceptanceModel:
    return read_model(built(text).graph)


def variant(name: str) -> Variant:
    return next(entry for story in model().stories for entry in story.variants if entry.iri.endswith(f"/{name}"))


def n(name: str) -> Iri:
    return Iri(T + name)


def t(*names: str) -> tuple[Iri, ...]:
    return tuple(Iri(T + name) for name in names)


def lab(*names: str) -> tuple[Iri, ...]:
    return tuple(Iri(LAB + name) for name in names)


@pytest.mark.parametrize("form", FORMATS)
def test_the_model_is_the_same_after_every_format(form: str) -> None:
    graph = built(EVERYTHING).graph
    first, second = read_model(graph), read_model(parse(serialize(graph, form), form))
    assert second == first
    assert repr(second) == repr(first)


def test_stories_and_variants_come_in_written_order() -> None:
    assert [(story.iri, [entry.iri for entry in story.variants]) for story in model().stories] == [
        (OTHER + "zz-first", [OTHER + "table", OTHER + "product"]),
        (T + "aa-second", [T + "chosen", T + "brought"]),
    ]
    first = model().stories[0]
    assert (first.role, first.feature, first.benefit) == ("operator", "parts", "work goes on")


def test_clauses_come_back_as_they_were_written() -> None:
    template = variant("table").template
    at, either, neither, config, slow, apart, put, _, text, first, second, behaviour, some = template.clauses
    assert isinstance(put, Fluent)
    assert put.named is not None
    assert (put.predicate, put.arguments) == (t("is-put")[0], {"thing": T + "var-part", "place": T + "var-goal"})
    assert put.named.sentence == '"{thing}" is-put at "{place}"'
    assert (template.start, template.end) == t("start", "end")
    assert at == Fluent(
        n("at"),
        "given",
        "located-at",
        {"object": T + "var-part", "workspace": T + "var-goal"},
        Before(T + "pick-start"),
    )
    assert isinstance(either, Junction)
    assert either.operator == "or"
    held, fine = either.operands
    assert isinstance(held, Fluent)
    assert held.time == Before(T + "end", 0.25)
    assert fine == TextClause(n("text-fetch.given.1.1"), "given", 'looks "fine"', After(T + "start"))
    assert isinstance(neither, Junction)
    assert neither.operator == "not"
    (both,) = neither.operands
    assert isinstance(both, Junction)
    assert (both.operator, len(both.operands)) == ("and", 2)
    assert isinstance(config, Fluent)
    assert config.arguments == {"target": T + "var-robot", "name": "speed", "value": T + "var-speed"}
    assert not isinstance(config.arguments["name"], Iri)
    assert isinstance(slow, Fluent)
    assert slow.arguments == {"agent": T + "var-robot", "limit": "0.25 m/s"}
    near = {"one": T + "var-robot", "distance": T + "var-near", "other": T + "var-goal"}
    assert slow.conditions == (Condition(n("whenever-fetch.slow"), "is-nearer-than", near),)
    assert isinstance(apart, Fluent)
    assert apart.arguments["distance"] == "3e-1 m"
    assert text == TextFluent(
        n("text"), "given", "{p} & {r}", {"p": n("var-part"), "r": n("var-robot")}, After(T + "end", 1.0)
    )
    assert [first, second] == [
        EventClause(n("when-evt-fetch.when.0"), n("start")),
        EventClause(n("when-evt-fetch.when.1"), Iri("https://example.org/taken/elsewhere")),
    ]
    assert behaviour == BehaviourClause(
        n("when-bhv-fetch.when"),
        "pick-place",
        {"agent": T + "var-robot", "object": T + "var-part", "workspace": T + "var-goal"},
        n("pick-start"),
        n("place-end"),
    )
    assert isinstance(some, Exists)
    assert (some.role, some.variable, some.in_set) == ("then", n("var-y"), n("var-goals"))
    clear = some.clauses[1]
    assert isinstance(clear, Fluent)
    assert clear.time == During(T + "start", T + "end")


def test_quantifiers_nest() -> None:
    outer, *_ = variant("product").template.clauses
    assert isinstance(outer, ForAll)
    _, inner = outer.clauses
    assert isinstance(inner, ForAll)
    assert (inner.variable, inner.in_set) == (n("var-b"), lab("places")[0])
    behaviour, taken = inner.clauses
    assert isinstance(behaviour, BehaviourClause)
    assert behaviour.behaviour == "pick"
    assert isinstance(taken, Fluent)


def test_a_horizon_is_a_variable() -> None:
    _, _, stays, in_time, text, *_ = variant("product").template.clauses
    assert isinstance(stays, Fluent)
    assert isinstance(in_time, Fluent)
    assert isinstance(text, TextClause)
    assert [clause.seconds for clause in (stays, in_time, text)] == [Iri(f"{T}var-wait")] * 3
    assert (stays.time, in_time.time) == (After(f"{T}end"), Before(f"{T}end", some_time=True))


def test_occurrences_of_events_are_selected() -> None:
    times = {clause.time for clause in variant("product").template.clauses if isinstance(clause, Fluent)}
    assert {
        Before(f"{T}place-end", 1.0, which="every"),
        After(f"{T}pick-start", some_time=True, which="first"),
        After(f"{T}place-end", which="last"),
    } <= times


def test_a_variant_has_its_own_clauses_behind_the_templates() -> None:
    extra, event, text = variant("table").clauses
    assert (extra.iri, event.iri) == (OTHER + "extra", OTHER + "when-evt-zz-first.table.when.0")
    assert isinstance(text, TextClause)
    assert text.role == "then"


def test_a_table_keeps_rows_cells_and_types() -> None:
    table = variant("table").variation
    assert isinstance(table, Table)
    assert table.variables == t("var-part", "var-robot", "var-goal", "var-speed", "var-near", "var-goals")
    assert table.rows == (
        (*lab("nut", "ur10", "tray_ws"), 0.1, "30 cm", lab("bench_ws", "tray_ws")),
        (*lab("bolt", "panda", "bench_ws"), "fast", "0.3 m", lab("tray_ws", "bench_ws")),
        (*lab("washer1", "panda", "bench_ws"), 2, "250 mm", ()),
    )
    assert [type(row[3]) for row in table.rows] == [float, str, int]


def test_a_product_keeps_choices_in_written_order() -> None:
    assert variant("product").variation == Product(
        t("var-parts", "var-bins", "var-robot", "var-wait"),
        (
            Selection("combinations", lab("bolt", "nut"), 2, True),
            (lab("tray_ws"), lab("bench_ws", "tray_ws")),
            lab("ur10", "panda"),
            (1, 2.5),
        ),
    )
    brought = variant("brought").variation
    assert isinstance(brought, Product)
    assert brought.choices[0] == lab("washer0", "washer1", "washer2")
    assert repr(brought.choices[3]) == "(1, 1.0, '1')"
    assert brought.choices[4] == ("30 cm", "0.3 m", "-.5e-1 m")
    assert brought.choices[5] == Selection("permutations", lab("bench_ws", "tray_ws"), 2, False)


def test_the_scene_of_a_variant_is_its_own_with_what_its_variation_brings() -> None:
    scene = variant("chosen").scene
    assert scene.objects == lab("bolt", "nut", "bench", "tray")
    assert scene.workspaces == lab("bench_ws", "tray_ws")
    assert scene.agents == lab("panda", "ur10")
    assert scene.carriers == {LAB + "bench_ws": lab("bench"), LAB + "tray_ws": lab("tray")}
    assert scene.contains == {LAB + "bench_ws": lab("tray_ws")}
    assert variant("brought").scene.objects == lab("bolt", "nut", "bench", "tray", "washer0", "washer1", "washer2")


def test_sets_kinds_and_prefixes_are_at_hand() -> None:
    found = model()
    assert repr(found.sets[Iri(OTHER + "mixed")]) == repr(
        (3, "20 %", -2.5, 1e21, 'a "word" <&> {x}', "Gruß", "two\nlines", LAB + "bench_ws", 3)
    )
    assert isinstance(found.sets[Iri(OTHER + "mixed")][7], Iri)
    assert found.kinds[Iri(LAB + "nut")] == "object"
    assert found.curie(LAB + "nut") == "env:nut"
    assert found.curie("https://example.org/taken/elsewhere") == "bdd:elsewhere"


NEEDED = [
    ("t:bench-to-tray", "bdd:of-template"),
    ("t:bench-to-tray", "bdd:has-variation"),
    ("t:fetch", "bdd:has-clause"),
    ("t:fetch", "time:after-event"),
    ("t:on-bench", "bdd:clause-of"),
    ("t:on-bench", "time:before-event"),
    ("t:on-bench", "bdd:ref-object"),
    ("t:on-bench", "rdf:type"),
    ("t:carry", "rdf:type"),
    ("t:when-bhv-fetch.when", "time:before-event"),
    ("t:fetch-scenario-given", "rdf:type"),
    ("t:tv-cart_prod-fetching.bench-to-tray", "bdd:variable-list"),
    ("t:tv-cart_prod-fetching.bench-to-tray", "bdd:of-sets"),
    ("env:parts", "rdf:type"),
]


@pytest.mark.parametrize(("subject", "term"), NEEDED)
def test_an_incomplete_variant_is_left_out_and_nothing_raises(subject: str, term: str) -> None:
    graph = built(MODEL).graph
    prefix, _, name = subject.partition(":")
    node = URIRef({"t": T, "env": LAB}[prefix] + name)
    graph.remove((node, URIRef(expand(term)), None))
    (story,) = read_model(graph).stories
    assert story.variants == ()


def test_a_variable_without_a_value_leaves_its_variant_out() -> None:
    (story,) = model(MODEL.replace("var <fetch.robot>: { <arms.panda> }", "")).stories
    assert story.variants == ()


def test_a_clause_that_contains_itself_leaves_its_variant_out() -> None:
    graph = built(EVERYTHING).graph
    node = URIRef(T + "forall-sort.all.all")
    head = BNode()
    graph.set((node, URIRef(expand("bdd:has-clause")), head))
    graph.add((head, RDF.first, node))
    graph.add((head, RDF.rest, RDF.nil))
    names = [entry.iri for story in read_model(graph).stories for entry in story.variants]
    assert names == [OTHER + "table", T + "brought"]


def test_a_list_that_never_ends_is_no_list() -> None:
    graph = built(MODEL).graph
    head = next(graph.objects(URIRef(T + "fetch"), URIRef(expand("bdd:has-clause"))))
    graph.set((head, RDF.rest, head))
    assert read_model(graph).stories[0].variants == ()


def test_a_graph_without_our_vocabulary_is_read_in_alphabetical_order() -> None:
    graph = Graph()
    for triple in built(MODEL).graph:
        if not str(triple[1]).startswith(expand("rbw:")):
            graph.add(triple)
    graph.bind("lab", LAB)
    found = read_model(graph)
    (story,) = found.stories
    (only,) = story.variants
    assert story.role == ""
    assert only.scene.objects == lab("bench", "bolt", "nut", "tray")
    assert only.scene.carriers == {LAB + "bench_ws": lab("bench"), LAB + "tray_ws": lab("tray")}
    assert found.curie(LAB + "nut") == "lab:nut"


def test_an_empty_graph_is_an_empty_model() -> None:
    assert read_model(Graph()).stories == ()
