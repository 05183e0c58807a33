"""Add results of runs to the graph of a model: the verdicts, their executions and the values used.

Verdicts on clauses are EARL assertions, and executions are PROV activities. Nodes are named after the content of the
results, so equal results give equal graphs.
"""

from __future__ import annotations

import hashlib
import json
from base64 import urlsafe_b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.graph.rdf.prefixes import user_prefixes
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.write.plain_statements import Statements

if TYPE_CHECKING:
    from rdflib import Graph, URIRef

OUTCOMES = {"holds": "earl:passed", "violated": "earl:failed", "unknown": "earl:cantTell"}
"""Verdict → EARL's outcome value."""
Json = Mapping[str, Any]
_NO_IRI = frozenset('<>" {}|\\^`')
"""Characters that an IRI cannot contain. A text with one of them is a literal."""


class BadResults(Exception):
    """A document does not follow ``docs/schemas/run.schema.json``. The message names the place of the error."""


def read_results(text: str) -> Json:
    """Parse the results of a run from JSON; raises ``BadResults``."""
    try:
        document: object = json.loads(text)
    except ValueError as error:
        raise BadResults(f"not JSON: {error}") from error
    return _object(document, "the document")


def add_results(graph: Graph, document: Json) -> None:
    """Add the results of a run to the graph of its model; raises ``BadResults``."""
    writer = _Writer(graph, user_prefixes(graph))
    run = writer.node(run_iri(document), "prov:Activity", "rbw:Run")
    writer.say(run, "rbw:seed", _field(document, "seed", int, "the run"))
    writer.say(run, "rbw:complete", _field(document, "complete", bool, "the run"))
    for number, entry in enumerate(_field(document, "scenarios", list, "the run"), start=1):
        writer.scenario(run, _object(entry, f"scenario {number}"), number)


def run_iri(document: Json) -> str:
    """Return the IRI of a run's node, named after the content of its results."""
    digest = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()[:16]
    return f"urn:robbdd:run:{digest}"


def add_traces(graph: Graph, document: Json, digests: Mapping[int, str]) -> None:
    """Add the traces of a run's executions as PROV entities that are named after their contents (RFC 6920).

    ``digests`` are the SHA-256 (hexadecimal) of the trace of each execution by its position (from 0).
    """
    writer = _Writer(graph, {})
    for index, digest in sorted(digests.items()):
        name = urlsafe_b64encode(bytes.fromhex(digest)).decode("ascii").rstrip("=")
        node = writer.node(f"ni:///sha-256;{name}", "prov:Entity")
        writer.link(node, "prov:wasGeneratedBy", f"{run_iri(document)}/{index + 1}")


@dataclass(frozen=True, slots=True)
class _Writer(Statements):
    prefixes: Mapping[str, str]

    def scenario(self, run: URIRef, entry: Json, number: int) -> None:
        where = f"scenario {number}"
        node = self.node(f"{run}/{number}", "prov:Activity", "rbw:ScenarioRun")
        self.link(node, "rbw:run", run)
        self.link(node, "rbw:of-story", _field(entry, "story", str, where))
        self.link(node, "rbw:of-variant", _field(entry, "variant", str, where))
        self.say(node, "rbw:variation-number", _field(entry, "variation", int, where))
        self.say(node, "rbw:repetition", entry.get("repetition", 1))
        self.say(node, "rbw:name", _field(entry, "name", str, where))
        self.say(node, "rbw:seed", _field(entry, "seed", int, where))
        self.link(node, "earl:outcome", self._outcome(entry, where))
        if entry.get("shared") is not None:
            self._shared(run, node, _object(entry["shared"], f"'shared' of {where}"), where)
        if entry.get("duration") is not None:
            self.say(node, "rbw:duration-seconds", float(_field(entry, "duration", (int, float), where)))
        for place, (variable, value) in enumerate(sorted(_field(entry, "values", dict, where).items()), start=1):
            self._value(node, f"{node}/value/{place}", str(variable), value)
        for place, clause in enumerate(_field(entry, "clauses", list, where), start=1):
            self._clause(node, f"{node}/clause/{place}", _object(clause, f"clause {place} of {where}"), entry)

    def _shared(self, run: URIRef, scenario: URIRef, entry: Json, where: str) -> None:
        """Add the behaviour-tree execution by which a scenario was judged. Other scenarios may share it."""
        from urllib.parse import quote

        name = _field(entry, "execution", str, where)
        execution = self.node(f"{run}/tree/{quote(name, safe='')}", "prov:Activity", "rbw:TreeExecution")
        self.link(execution, "rbw:run", run)
        self.link(execution, "rbw:of-tree", _field(entry, "tree", str, where))
        self.link(scenario, "rbw:judged-from", execution)
        self.link(scenario, "prov:wasInformedBy", execution)
        self.link(scenario, "rbw:of-node", _field(entry, "node", str, where))

    def _value(self, run: URIRef, iri: str, variable: str, value: object) -> None:
        node = self.node(iri, "rbw:GivenValue")
        self.link(run, "rbw:given-value", node)
        self.link(node, "rbw:of-variable", self._named(variable))
        for one in cast("list[object]", value) if isinstance(value, list) else [value]:
            known = self._named(one) if isinstance(one, str) and not _NO_IRI & set(one) else None
            if known is not None and (known, None, None) in self.graph:
                self.link(node, "rbw:is-value", known)
            elif isinstance(one, str | int | float):
                self.say(node, "rbw:is-value", one)

    def _clause(self, run: URIRef, iri: str, clause: Json, scenario: Json) -> None:
        where = f"the clause {clause.get('name')}"
        node = self.node(iri, "earl:Assertion", "prov:Entity")
        self.link(node, "prov:wasGeneratedBy", run)
        self.link(node, "earl:test", _field(clause, "iri", str, where))
        self.link(node, "earl:subject", _field(scenario, "variant", str, where))
        self.link(node, "earl:mode", expand("earl:automatic"))
        result = self.node(f"{iri}/result", "earl:TestResult")
        self.link(node, "earl:result", result)
        self.link(result, "earl:outcome", self._outcome(clause, where))
        for field, term in (("robustness", "rbw:robustness"), ("at", "rbw:at-seconds")):
            if clause.get(field) is not None:
                self.say(result, term, float(_field(clause, field, (int, float), where)))
        for field, term in (("unit", "rbw:unit"), ("reason", "earl:info")):
            if clause.get(field):
                self.say(result, term, _field(clause, field, str, where))

    def _named(self, curie: str) -> Any:
        """Return the node of a CURIE whose prefix the model declares. Any other text is the IRI of a node."""
        from rdflib import URIRef

        prefix, colon, local = curie.partition(":")
        return URIRef(self.prefixes[prefix] + local if colon and prefix in self.prefixes else curie)

    def _outcome(self, entry: Json, where: str) -> str:
        verdict = _field(entry, "verdict", str, where)
        if verdict not in OUTCOMES:
            raise BadResults(f"the verdict of {where} is '{verdict}', not one of {', '.join(OUTCOMES)}")
        return expand(OUTCOMES[verdict])


def _object(value: object, where: str) -> Json:
    if not isinstance(value, dict):
        raise BadResults(f"{where} is not an object")
    return cast(Json, value)


def _field(entry: Json, name: str, kind: Any, where: str) -> Any:
    value = entry.get(name)
    if not isinstance(value, kind):
        raise BadResults(f"'{name}' of {where} is {'missing' if value is None else 'not of the expected type'}")
    return value
