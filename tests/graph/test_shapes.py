"""Each shape finds what it is there for: a sound graph is damaged in one way, and the shape must say so.

Text reaches only some of these; a graph from elsewhere, or a mistake of ours in building one, reaches all.
"""

from dataclasses import replace
from functools import cache

import pytest
from rdflib import BNode, Graph, Literal, URIRef
from rdflib.collection import Collection
from rdflib.namespace import RDF, SH
from rdflib.term import Node

from graph.models import EVERYTHING
from graph.statements import built
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.rdf.vocabulary import QUANTITY, SHAPES, expand
from robbdd_tools.graph.shapes.installed import load_shapes
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.build import BuiltGraph

NAMES = {"t": "https://example.org/t/", "lab": "https://example.org/env/", "o": "https://example.org/other/"}
TABLE = "o:tv-table-zz-first.table"
PRODUCT = "o:tv-cart_prod-zz-first.product"
EXECUTION = [
    "+ t:run a bdd:ScenarioExecution",
    "+ t:run bdd:of-variant o:table",
    "+ t:run bdd:has-behaviour-implementation t:server",
    "+ t:server a bdd:BehaviourImplementation",
    "+ t:run obs:has-policy t:watch",
    "+ t:watch a obs:ObservationPolicy",
    "+ t:watch bdd:of-clause t:at",
]
STUDY = [
    "+ t:study a rbw:Study",
    "+ t:study rbw:of-variant o:table",
]
DAMAGE: dict[str, list[str]] = {
    "study-scenarios": [*STUDY, "+ t:study rbw:of-variant t:fetch"],
    "study-factors": [*STUDY, "+ t:study rbw:factor-list (t:fetch)"],
    "study-repetitions": [*STUDY, "+ t:study rbw:repetitions 0"],
    "study-seed": [*STUDY, "+ t:study rbw:seed -1"],
    "study-design": [*STUDY, "+ t:study rbw:design t:points", "+ t:points rbw:design-size 0"],
    "study-rule": [*STUDY, "+ t:study rbw:stopping-rule t:one", "+ t:study rbw:stopping-rule t:two"],
    "factor-levels": ["+ t:scenes a rbw:SceneFactor", "+ t:scenes rbw:level-list ()"],
    "factor-implementation": ["+ t:code a rbw:BehaviourFactor", "+ t:code rbw:replaces t:fetch"],
    "factor-variable": ["+ t:range a rbw:RangeFactor", "+ t:range rbw:of-variable t:fetch"],
    "factor-bounds": ["+ t:range a rbw:RangeFactor", "+ t:range rbw:from-value 2", "+ t:range rbw:to-value 1"],
    "factor-upper-bound": ["+ t:range a rbw:RangeFactor", "+ t:range rbw:from-value 1"],
    "goal-kind": ["+ t:goal a rbw:CoverageGoal", "+ t:goal rbw:coverage-kind 1"],
    "goal-percentage": ["+ t:goal a rbw:CoverageGoal", "+ t:goal rbw:percentage 101"],
    "rule-width": ["+ t:rule a rbw:WidthRule", "+ t:rule rbw:width 1"],
    "rule-rate": ["+ t:rule a rbw:RateRule", "+ t:rule rbw:required-rate 1", "+ t:rule rbw:refuted-rate 2"],
    "rule-required-rate": ["+ t:rule a rbw:RateRule", "+ t:rule rbw:required-rate 1"],
    "after-one-event": ["- t:taken time:after-event"],
    "after-only": ["+ t:taken time:before-event t:end"],
    "angle-value": ["- t:level rbw:limit", "+ t:level rbw:limit t:var-robot"],
    "force-value": ["+ t:at a rbw:PressesWithLessThanPredicate", "+ t:at rbw:limit t:var-robot"],
    "length-value": ["- t:apart rbw:distance", "+ t:apart rbw:distance t:var-robot"],
    "ratio-value": ["+ t:at a rbw:KeepsJointsFromLimitsPredicate", "+ t:at rbw:share t:var-robot"],
    "speed-value": ["- t:slow rbw:limit", "+ t:slow rbw:limit t:var-robot"],
    "time-value": ["- t:fast rbw:limit", "+ t:fast rbw:limit t:var-robot"],
    "agent-members": ["- lab:bench_scene-scene-has-agn agn:has-agent"],
    "agent-value": [f"set {TABLE} bdd:rows ((lab:nut lab:nut lab:tray_ws 1 2 ()))"],
    "before-one-event": ["- t:seen time:before-event"],
    "before-only": ["+ t:seen time:after-event t:end"],
    "composition-contents": ["- lab:tray_comp env:has-object"],
    "composition-cycle": ["+ lab:tray_comp env:has-workspace lab:bench_ws"],
    "composition-objects": ["+ lab:tray_comp env:has-object lab:panda"],
    "composition-workspace": ["+ lab:tray_comp env:of-workspace lab:bench_ws"],
    "composition-workspaces": ["+ lab:bench_comp env:has-workspace lab:nut"],
    "column-property": ["+ lab:column a rbw:PropertyColumn", "+ lab:column rbw:of-set lab:parts"],
    "column-set": ["+ lab:column a rbw:PropertyColumn", "+ lab:column rbw:of-set lab:nut"],
    "condition-role": ["- t:at bdd:clause-of", "+ t:at bdd:clause-of t:fetch-scenario-when"],
    "coordination-node-one": ["+ t:pick rbw:coordination-node t:fetch"],
    "external-node-one": ["+ t:pick rbw:external-node t:fetch", "+ t:pick rbw:external-node t:end"],
    "external-node-only": ["+ t:pick rbw:external-node t:fetch", "+ t:pick rbw:coordination-node t:fetch"],
    "correct-objects": ["+ lab:tray_ws rbw:correct-for lab:panda"],
    "correct-workspace": ["+ lab:tray rbw:correct-for lab:nut"],
    "during-end": ["- t:drop time:before-event"],
    "during-start": ["- t:drop time:after-event"],
    "element-value": [f"set {TABLE} bdd:rows ((lab:nut 7 lab:tray_ws 1 2 ()))"],
    "emission-event": ["+ t:emits a rbw:Emission", "+ t:emits rbw:event t:task"],
    "emission-moment": ["+ t:emits a rbw:Emission", "+ t:emits rbw:event t:end"],
    "empty-duration": ["- t:drop time:after-event", "+ t:drop time:after-event t:end"],
    "event-type-after": ["- t:taken time:after-event", "+ t:taken time:after-event t:task"],
    "event-type-before": ["- t:seen time:before-event", "+ t:seen time:before-event t:task"],
    "execution-behaviour": [*EXECUTION, "- t:server rdf:type"],
    "execution-log-one": [*EXECUTION, "+ t:run rbw:log t:server"],
    "robot-log-path": [*EXECUTION, "+ t:monday a rbw:RobotLog"],
    "execution-policies": [*EXECUTION, "+ t:watch bdd:of-clause t:seen"],
    "execution-variant": [*EXECUTION, "+ t:run bdd:of-variant o:product"],
    "fluent-predicate": ["+ t:at a bdd:CanReach"],
    "for-all-role": ["+ t:forall-sort.all bdd:clause-of t:sort-scenario-then"],
    "horizon": ["- t:held time:horizon-seconds", "+ t:held time:horizon-seconds -1"],
    "horizon-number": ["- t:stays rbw:horizon-variable", "+ t:stays rbw:horizon-variable t:var-robot"],
    "horizon-once": ["+ t:stays time:horizon-seconds 2"],
    "horizon-value": [f"set {PRODUCT} bdd:of-sets ((lab:nut) (lab:nut) (lab:panda) (0))"],
    "horizon-variable": ["- t:stays rbw:horizon-variable", "+ t:stays rbw:horizon-variable t:task"],
    "instance-scene": ["+ t:simulated a rbw:SceneInstance", "+ t:simulated rbw:scene t:fetch"],
    "junction-operands": ["set t:not-fetch.given.2 rbw:operands ()"],
    "membership-scene": ["+ lab:bench_scene-scene-has-obj bdd:of-scene t:fetch-scene", "+ t:fetch-scene a bdd:Scene",
                         "+ lab:bench_scene-scene-has-obj bdd:of-scene t:sort-scene"],
    "occurrence": ["- t:calm-once rbw:occurrence", "+ t:calm-once rbw:occurrence t:task"],
    "object-members": ["+ lab:bench_scene-scene-has-obj env:has-object lab:panda"],
    "object-value": [f"set {TABLE} bdd:rows ((lab:panda lab:panda lab:tray_ws 1 2 ()))"],
    "named-predicate-phrase": ["- t:is-put rbw:phrase"],
    "named-predicate-parameters": ["- t:is-put rbw:parameters"],
    "named-predicate-definition": ["- t:is-put rbw:defined-as"],
    "state-operands": ["- t:state-is-put rbw:operands"],
    "named-use-predicate": ["- t:put rbw:named-predicate"],
    "named-use-values": ["set t:put rbw:argument-list (t:var-part)"],
    "whenever-conditions": ["+ t:guarded rbw:whenever t:placed"],
    "defined-event-conditions": ["- t:one-in rbw:occurs-when"],
    "defined-event-seconds": ["+ t:all-in rbw:horizon-variable t:var-robot"],
    "whenever-predicate": ["- t:whenever-fetch.guarded a", "+ t:whenever-fetch.guarded a rbw:Condition"],
    "whenever-some-time": ["+ t:guarded a rbw:AtSomeTime"],
    "some-time": ["+ t:at a rbw:AtSomeTime"],
    "policy-clause": [*EXECUTION, "- t:watch bdd:of-clause"],
    "product-sets": [f"- {PRODUCT} bdd:of-sets"],
    "product-width": [f"set {PRODUCT} bdd:of-sets ((lab:nut) (lab:panda))"],
    "quantifier-clauses": ["set t:forall-sort.all.all bdd:has-clause ()"],
    "quantifier-set": ["- t:forall-sort.all bdd:in-set", "+ t:forall-sort.all bdd:in-set t:var-robot"],
    "quantifier-variable": ["+ t:forall-sort.all bdd:ref-variable t:var-robot"],
    "pair-first": ["+ t:pair a rbw:PairFriction"],
    "pair-second": ["+ t:pair a rbw:PairFriction"],
    "realisation-element": ["+ t:realised a rbw:Realisation"],
    "row-width": [f"set {TABLE} bdd:rows ((lab:nut))"],
    "scenario-behaviour": ["- t:sort-scenario bhv:of-behaviour"],
    "scenario-further": ["+ t:sort-scenario rbw:further-behaviour lab:nut"],
    "scenario-given": ["- t:sort-scenario bdd:given"],
    "scenario-task": ["- t:sort-scenario task:of-task"],
    "scenario-then": ["- t:sort-scenario bdd:then"],
    "scenario-when": ["- t:sort-scenario bdd:when"],
    "scene-entries": ["set lab:bench_scene rbw:entries ()"],
    "selection-length": ["- o:comb-zz-first.product.0 bdd:length"],
    "selection-size": ["- o:comb-zz-first.product.0 bdd:repetition-allowed", "- o:comb-zz-first.product.0 bdd:length",
                       "+ o:comb-zz-first.product.0 bdd:length 3"],
    "selection-source": ["- o:comb-zz-first.product.0 bdd:from", "+ o:comb-zz-first.product.0 bdd:from t:var-parts"],
    "set-elements": ["- lab:furniture bdd:elements"],
    "set-for-single": [f"set {TABLE} bdd:rows ((lab:parts lab:panda lab:tray_ws 1 2 ()))"],
    "similar-count": ["- lab:washers rbw:count", "+ lab:washers rbw:count 0"],
    "single-for-set": [f"set {TABLE} bdd:rows ((lab:nut lab:panda lab:tray_ws 1 2 lab:tray_ws))"],
    "story-criteria": ["- t:aa-second bdd:has-criteria"],
    "table-rows": [f"set {TABLE} bdd:rows ()"],
    "takes-less-than-end": ["- t:fast time:before-event"],
    "takes-less-than-start": ["- t:fast time:after-event"],
    "takes-less-than-throughout": ["+ t:fast a rbw:AtSomeTime"],
    "takes-less-than-whenever": ["+ t:fast rbw:whenever t:whenever-fetch.guarded"],
    "template-clauses": ["set t:sort bdd:has-clause ()"],
    "template-duration": ["- t:sort time:after-event"],
    "template-duration-end": ["- t:sort time:before-event"],
    "template-scenario": ["- t:sort bdd:of-scenario"],
    "template-scene": ["+ t:sort bdd:has-scene t:fetch-scene"],
    "text-clause-text": ["- t:text-fetch.given.1.1 rbw:text"],
    "text-predicate-names": ["- t:text bdd:argument-names"],
    "text-predicate-text": ["- t:text bdd:template-string"],
    "text-predicate-variables": ["- t:text bdd:argument-variables"],
    "requirement-text": ["+ t:need a rbw:Requirement"],
    "verifying-requirement": ["+ t:at rbw:verifies t:task"],
    "timed-once": ["+ t:at a time:AfterEventConstraint"],
    "variable-empty": [f"set {PRODUCT} bdd:of-sets (() () () ())"],
    "variable-foreign": ["set t:sort rbw:variables (t:var-parts t:var-bins t:var-wait)"],
    "variable-missing": ["set t:sort rbw:variables (t:var-parts t:var-bins t:var-robot t:var-wait t:var-goal)"],
    "variable-repeated": [f"set {PRODUCT} bdd:variable-list (t:var-parts t:var-bins t:var-robot t:var-robot)"],
    "variant-members": ["- t:chosen bdd:has-scene"],
    "variant-scene": ["+ t:chosen bdd:has-scene lab:bench_scene-scene-has-obj"],
    "tree-children": ["+ t:whole a bt:Sequence", "+ t:tree a bt:BehaviourTree", "+ t:tree bt:root t:whole",
                      "+ t:whole bt:children ()"],
    "tree-made": ["+ t:tree a bt:BehaviourTree"],
    "tree-node-parent": ["+ t:one a bt:Sequence", "+ t:two a bt:Sequence", "+ t:leaf a bt:Action",
                         "+ t:one bt:children (t:two t:leaf)", "+ t:two bt:children (t:leaf)",
                         "+ t:tree a bt:BehaviourTree", "+ t:tree bt:root t:one"],
    "tree-node-root": ["+ t:one a bt:Sequence", "+ t:two a bt:Sequence",
                       "+ t:one bt:children (t:two)", "+ t:two bt:children (t:one)"],
    "tree-node-tree": ["+ t:leaf a rbw:TreeNode"],
    "tree-root": ["+ t:tree a bt:BehaviourTree", "+ t:tree bt:root t:one", "+ t:tree bt:root t:two"],
    "variant-template": ["+ t:chosen bdd:of-template t:fetch"],
    "variant-variation": ["- t:chosen bdd:has-variation"],
    "variation-task": [f"+ {TABLE} task:of-task t:start"],
    "variation-variables": [f"- {TABLE} bdd:variable-list"],
    "when-behaviour": ["- t:when-bhv-fetch.when rdf:type", "+ t:when-bhv-fetch.when a bdd:WhenBehaviour"],
    "when-behaviour-one": ["- t:when-bhv-fetch.when bhv:of-behaviour"],
    "when-behaviour-role": ["- t:when-bhv-fetch.when bdd:clause-of"],
    "when-behaviour-together": ["+ t:when-bhv-fetch.when rbw:together-with lab:nut"],
    "when-event-event": ["- t:when-evt-fetch.when.0 rbw:event"],
    "when-event-role": ["- t:when-evt-fetch.when.0 bdd:clause-of"],
    "workspace-members": ["+ lab:bench_scene-scene-has-ws env:has-workspace lab:panda"],
    "workspace-value": [f"set {TABLE} bdd:rows ((lab:nut lab:panda lab:nut 1 2 ()))"],
}  # fmt: skip


@cache
def sound() -> BuiltGraph:
    return built(EVERYTHING)


def node(text: str) -> Node:
    if text.lstrip("-").isdigit():
        return Literal(int(text))
    prefix, _, local = text.partition(":")
    return URIRef(NAMES[prefix] + local if prefix in NAMES else expand(text))


def damaged(edits: list[str]) -> BuiltGraph:
    graph = Graph()
    for triple in sound().graph:
        graph.add(triple)
    for edit in edits:
        action, subject, term, *values = edit.split(" ", 3)
        predicate = RDF.type if term == "a" else URIRef(expand(term))
        if action == "-":
            assert (node(subject), predicate, None) in graph, edit
            graph.remove((node(subject), predicate, None))
        elif action == "+":
            made = nested_list(graph, values[0]) if values[0].startswith("(") else node(values[0])
            graph.add((node(subject), predicate, made))
        else:
            assert (node(subject), predicate, None) in graph, edit
            graph.set((node(subject), predicate, nested_list(graph, values[0])))
    return replace(sound(), graph=graph)


def nested_list(graph: Graph, text: str) -> Node:
    stack: list[list[Node]] = [[]]
    for token in text.replace("(", " ( ").replace(")", " ) ").split():
        if token == "(":
            stack.append([])
        elif token == ")":
            items = stack.pop()
            stack[-1].append(Collection(graph, BNode(), list(items)).uri if items else RDF.nil)
        else:
            stack[-1].append(node(token))
    return stack[0][0]


def codes(graph: BuiltGraph, shapes: Graph | None = None) -> set[str]:
    return {entry.code.removeprefix("shacl-") for entry in validate(graph, shapes)}


def test_the_model_with_every_construct_is_sound() -> None:
    assert codes(sound()) == set()


@pytest.mark.parametrize("shape", DAMAGE)
def test_a_shape_finds_its_damage(shape: str) -> None:
    assert shape in codes(damaged(DAMAGE[shape]))


def word_slots() -> list[tuple[str, str]]:
    catalog = load_catalog()
    words = (*catalog.predicates.values(), *catalog.behaviours.values())
    return [(word.name, slot.name) for word in words for slot in word.slots]


def test_no_shape_is_without_a_test() -> None:
    shapes = load_shapes()
    named = {str(name).removeprefix(SHAPES) for name in shapes.subjects(RDF.type, SH.PropertyShape)}
    with_message = {str(name).removeprefix(SHAPES) for name in shapes.subjects(SH.message)}
    assert named | with_message == set(DAMAGE) | {f"{word}-{slot}" for word, slot in word_slots()}


@pytest.mark.parametrize(
    ("term", "value", "is_length"),
    [
        ("cdt:ucum", "0.3 m", True),
        ("cdt:ucum", "-3e-1 mm", True),
        ("cdt:ucum", "0.3 m/s", False),
        ("cdt:ucum", "m", False),
        ("cdt:ucum", "0.3", False),
        ("xsd:string", "0.3 m", False),
    ],
)
def test_a_quantity_in_a_graph_has_the_dimension_that_its_predicate_needs(
    term: str, value: str, is_length: bool
) -> None:
    graph = Graph()
    for triple in sound().graph:
        graph.add(triple)
    datatype = QUANTITY if term == "cdt:ucum" else expand(term)
    graph.set((node("t:apart"), URIRef(expand("rbw:distance")), Literal(value, datatype=URIRef(datatype))))
    found = codes(replace(sound(), graph=graph))
    assert found == (set() if is_length else {"is-farther-than-distance"})


@pytest.mark.parametrize(("word", "slot"), word_slots())
def test_each_slot_of_the_catalog_has_a_shape_that_wants_it_filled_once(word: str, slot: str) -> None:
    catalog = load_catalog()
    found = catalog.predicates.get(word) or catalog.behaviours[word]
    subject, behaviour = URIRef("https://example.org/t/clause"), URIRef("https://example.org/t/behaviour")
    graph = Graph()
    if word in catalog.behaviours:
        graph.add((subject, RDF.type, URIRef(expand("bdd:WhenBehaviour"))))
        graph.add((subject, URIRef(expand("bhv:of-behaviour")), behaviour))
        for kind in catalog.behaviours[word].rdf_types:
            graph.add((behaviour, RDF.type, URIRef(expand(kind))))
    else:
        graph.add((subject, RDF.type, URIRef(expand("bdd:FluentClause"))))
        graph.add((subject, RDF.type, URIRef(expand(catalog.predicates[word].rdf_type))))
    for filled in found.slots:
        if filled.name != slot:
            graph.add((subject, URIRef(expand(filled.property)), URIRef("https://example.org/t/value")))
    assert f"{word}-{slot}" in codes(replace(sound(), graph=graph))


@pytest.mark.parametrize("name", sorted(DAMAGE))
def test_every_message_is_a_sentence_about_robots_and_not_about_rdf(name: str) -> None:
    (message,) = (str(text) for text in load_shapes().objects(URIRef(SHAPES + name), SH.message))
    assert not {"node", "triple", "SHACL", "IRI", "RDF", "property"} & set(message.split())
    assert len(list(load_shapes().objects(URIRef(SHAPES + name), SH.severity))) == 1
