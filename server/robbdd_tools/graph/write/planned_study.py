"""Write a study as triples: its scenarios, factors with levels, design, seeds, stopping rule, required rate, goals.

The nodes are named after the digest of the study, so equal studies have equal graphs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.records import Records
from robbdd_tools.graph.write.plain_statements import Statements
from robbdd_tools.syntax.study_content import GRID, LATIN, SOBOL

if TYPE_CHECKING:
    from rdflib import Graph, URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.syntax.study_content import Factor, Range, StudyText, Word

DESIGN_TYPES = {LATIN: "rbw:LatinHypercube", SOBOL: "rbw:SobolSequence", GRID: "rbw:Grid"}
"""Kind of a design → its class."""
NUMBERS = {
    "first": "rbw:scenario-limit",
    "sample": "rbw:sample-size",
    "pairwise": "rbw:covering-strength",
    "repeat": "rbw:repetitions",
    "seed": "rbw:seed",
    "batch": "rbw:batch-size",
}
"""Setting that is a whole number → its property."""


def study_iri(digest: str) -> str:
    """Return the IRI of a study."""
    return f"urn:robbdd:study:{digest[:16]}"


def joined(models: Sequence[BuiltGraph]) -> BuiltGraph:
    """Return the graphs of several models as one, with the places of the first model."""
    from rdflib import Graph

    graph = Graph("SimpleMemory", bind_namespaces="none")
    for model in models:
        for prefix, namespace in model.graph.namespaces():
            graph.bind(prefix, namespace, override=True, replace=True)
        for triple in model.graph:
            graph.add(triple)
    return replace(models[0], graph=graph)


def add_study(graph: Graph, content: StudyText, digest: str, variants: Iterable[str]) -> None:
    """Add a study to the graph of its models. ``variants`` are the IRIs of the scenarios that it executes."""
    _Writer(graph, content, study_iri(digest)).write(variants)


def factor_names(content: StudyText) -> Iterator[str]:
    """Yield the names of the factors in the results, in the order of the study."""
    for factor in content.factors:
        yield "scene" if factor.implementation is None else factor.implementation.text


def add_study_run(graph: Graph, content: StudyText, digest: str, run: str, levels: Iterable[Mapping[str, str]]) -> None:
    """Link the results of a study to the study. ``run`` is the IRI of their run (see ``run_results``).

    ``levels`` are the levels of each execution by factor, in the order of the executions.
    """
    to, study = Statements(graph), study_iri(digest)
    to.link(to.node(run), "prov:used", study)
    names = list(factor_names(content))
    for number, stated in enumerate(levels, start=1):
        for place, name in enumerate(names, start=1):
            node = to.node(f"{run}/{number}/level/{place}", "rbw:GivenLevel")
            to.link(to.node(f"{run}/{number}"), "rbw:given-level", node)
            to.link(node, "rbw:of-factor", f"{study}/factor/{place}")
            to.say(node, "rbw:is-level", stated[name])


class _Writer:
    def __init__(self, graph: Graph, content: StudyText, iri: str) -> None:
        self._to = Statements(graph)
        self._content = content
        self._study = self._to.node(iri, "prov:Plan", "rbw:Study")
        records = Records(graph)
        self._implementations = records.instances("bdd:BehaviourImplementation")
        self._variables = records.instances("bdd:ScenarioVariable")

    def write(self, variants: Iterable[str]) -> None:
        to, study, content = self._to, self._study, self._content
        to.say(study, "rbw:name", content.name)
        to.enlist(study, "rbw:model-files", (to.literal(word.text) for word in content.imports))
        for variant in variants:
            to.link(study, "rbw:of-variant", variant)
        if content.where is not None:
            to.say(study, "rbw:selection", content.where.text)
        for name, term in NUMBERS.items():
            value = content.whole(name)
            if value is not None:
                to.say(study, term, value)
        if "timeout" in content.numbers:
            to.say(study, "rbw:timeout-seconds", float(content.numbers["timeout"]))
        if content.is_blocked:
            to.say(study, "rbw:block", "repetition")
        if content.traces is not None:
            to.say(study, "rbw:kept-traces", "failures" if content.traces.failures else "all")
            to.say(study, "rbw:trace-limit-megabytes", content.traces.limit)
        to.enlist(study, "rbw:factor-list", (*self._factors(), *self._ranges()))
        self._design()
        self._rule()
        self._goals()

    def _factors(self) -> Iterator[Node]:
        for place, factor in enumerate(self._content.factors, start=1):
            yield self._factor(f"{self._study}/factor/{place}", factor)

    def _factor(self, iri: str, factor: Factor) -> URIRef:
        if factor.implementation is None:
            node = self._to.node(iri, "rbw:Factor", "rbw:SceneFactor")
        else:
            node = self._to.node(iri, "rbw:Factor", "rbw:BehaviourFactor")
            self._to.link(node, "rbw:replaces", self._implementation(factor.implementation))
        self._to.enlist(node, "rbw:level-list", map(self._level, factor.levels))
        return node

    def _level(self, word: Word) -> Node:
        return self._implementation(word) if word.is_name else self._to.literal(word.text)

    def _implementation(self, word: Word) -> Node:
        found = next((iri for iri in self._implementations if _is_named(iri, word.text)), None)
        return self._to.literal(word.text) if found is None else self._to.node(found)

    def _ranges(self) -> Iterator[Node]:
        first = len(self._content.factors) + 1
        for place, one in enumerate(self._content.ranges, start=first):
            yield self._range(f"{self._study}/factor/{place}", one)

    def _range(self, iri: str, one: Range) -> URIRef:
        node = self._to.node(iri, "rbw:Factor", "rbw:RangeFactor")
        name = one.variable.text.rpartition(".")[2]
        for variable in self._variables:
            if _is_named(variable, f"var-{name}"):
                self._to.link(node, "rbw:of-variable", variable)
        self._to.say(node, "rbw:from-value", float(one.low))
        self._to.say(node, "rbw:to-value", float(one.high))
        if one.unit:
            self._to.say(node, "rbw:unit", one.unit)
        return node

    def _design(self) -> None:
        design = self._content.design
        if design is not None:
            node = self._to.node(f"{self._study}/design", DESIGN_TYPES[design.kind])
            self._to.link(self._study, "rbw:design", node)
            self._to.say(node, "rbw:design-size", design.size)

    def _goals(self) -> None:
        for kind, share in self._content.goals.items():
            node = self._to.node(f"{self._study}/goal/{kind}", "rbw:CoverageGoal")
            self._to.link(self._study, "rbw:coverage-goal", node)
            self._to.say(node, "rbw:coverage-kind", kind)
            self._to.say(node, "rbw:percentage", float(share))

    def _rule(self) -> None:
        numbers = self._content.numbers
        kinds = (
            ("rbw:WidthRule", {"stop width": "rbw:width"}),
            ("rbw:RateRule", {"stop rate": "rbw:required-rate", "stop against": "rbw:refuted-rate"}),
        )
        for kind, terms in kinds:
            if terms.keys() <= numbers.keys():
                node = self._to.node(f"{self._study}/stopping-rule", kind)
                self._to.link(self._study, "rbw:stopping-rule", node)
                for name, term in terms.items():
                    self._to.say(node, term, float(numbers[name]))


def _is_named(iri: str, name: str) -> bool:
    """Return whether an IRI ends with a local name, or is the IRI itself; a CURIE counts by its local name."""
    return iri == name or iri.endswith(("/" + name.rpartition(":")[2], "#" + name.rpartition(":")[2]))
