"""Handle terms in queries that graphs of RobBDD express differently or do not use.

Terms of the metamodel in the 2025 paper are expressed differently.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.graph.rdf.vocabulary import TIME_TYPES, expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

MIN_ALIKE = 0.6
"""Minimum similarity of a suggestion."""
MAX_KNOWN = 5000
"""Maximum number of terms that are searched for a suggestion. More terms would take seconds."""
Pattern = tuple[Any, Any, Any]


def patterns(algebra: Any) -> Iterator[Pattern]:
    """Yield the triple patterns of a query."""
    for part in operators(algebra):
        if part.name == "BGP":
            yield from part["triples"]


def operators(algebra: Any) -> Iterator[Any]:
    """Yield all operators of a query."""
    waiting: list[Any] = [algebra]
    while waiting:
        part = waiting.pop()
        if isinstance(part, dict):
            fields = cast("dict[str, Any]", part)
            if hasattr(fields, "name"):
                yield fields
            waiting += fields.values()
        elif isinstance(part, list | tuple):
            waiting += cast("list[Any]", part)


def with_paper_terms(graph: Graph, asked: list[Pattern]) -> Graph:
    """If a query uses ``bdd:holds-at``, return the graph with additional triples of the 2025 paper's metamodel.

    In the paper, a clause has a time constraint (``bdd:holds-at``), and a template has clauses (``bdd:has-clause``). In
    our graphs, as in those of the published tools, the time constraint is on the clause itself, and the clauses are a
    list.
    """
    from rdflib import RDF, URIRef

    holds_at, has_clause = URIRef(expand("bdd:holds-at")), URIRef(expand("bdd:has-clause"))
    if holds_at not in set(_terms(asked)) or (None, holds_at, None) in graph:
        return graph
    found = type(graph)(bind_namespaces="none")
    found += graph
    for kind in TIME_TYPES.values():
        for clause in graph.subjects(RDF.type, URIRef(expand(kind))):
            if (clause, RDF.type, URIRef(expand("bdd:FluentClause"))) in graph:
                found.add((clause, holds_at, clause))
    for owner, clauses in graph.subject_objects(has_clause):
        for clause in _with_operands(graph, clauses):
            found.add((owner, has_clause, clause))
    return found


def _with_operands(graph: Graph, clauses: Node) -> Iterator[Node]:
    """Yield the clauses of a list and those inside its groups (for example, ``not`` and ``or``)."""
    from rdflib import URIRef

    for clause in graph.items(clauses):
        yield clause
        for operands in graph.objects(clause, URIRef(expand("rbw:operands"))):
            yield from _with_operands(graph, operands)


def unknown_terms(graph: Graph, asked: list[Pattern], prefixes: Mapping[str, str], text: str) -> list[str]:
    """Return a remark on each term in a query's patterns that no triple contains.

    The remark names the most similar term that some triple contains.
    """
    predicates = set(graph.predicates())
    others: set[Node] = {*graph.subjects(), *graph.objects()}
    remarks: dict[str, None] = {}
    for subject, predicate, object_ in asked:
        unknown = [(term, predicates) for term in _iris(predicate) if term not in predicates]
        unknown += [(term, others) for term in (*_iris(subject), *_iris(object_)) if term not in others]
        for term, known in unknown:
            remarks[_remark(term, known, prefixes, text)] = None
    return list(remarks)


def _remark(term: Node, known: set[Node], prefixes: Mapping[str, str], text: str) -> str:
    name = shortened(str(term), prefixes)
    line = text[: _place(name, str(term), text)].count("\n") + 1
    near = get_close_matches(name, _names(known, prefixes), n=1, cutoff=MIN_ALIKE)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    return f"line {line}: '{name}' occurs in no triple{hint}"


def _names(known: set[Node], prefixes: Mapping[str, str]) -> list[str]:
    from rdflib import URIRef

    iris = sorted(str(term) for term in known if isinstance(term, URIRef))
    return [shortened(iri, prefixes) for iri in iris[:MAX_KNOWN]]


def _place(name: str, iri: str, text: str) -> int:
    for written in (name, f"<{iri}>"):
        found = re.search(rf"(?<![\w.\-:]){re.escape(written)}(?![\w\-])", text)
        if found:
            return found.start()
    return 0


def shortened(iri: str, prefixes: Mapping[str, str]) -> str:
    """Return an IRI with the longest matching prefix, or in full."""
    fitting = [(ns, prefix) for prefix, ns in prefixes.items() if iri.startswith(ns) and len(iri) > len(ns)]
    if not fitting:
        return iri
    namespace, prefix = max(fitting, key=lambda pair: len(pair[0]))
    return f"{prefix}:{iri[len(namespace) :]}"


def _terms(asked: list[Pattern]) -> Iterator[Node]:
    for pattern in asked:
        for part in pattern:
            yield from _iris(part)


def _iris(part: Any) -> Iterator[Node]:
    """Yield the IRIs in a part of a pattern: the part itself, or the IRIs of a property path."""
    from rdflib import URIRef
    from rdflib.paths import Path

    if isinstance(part, URIRef):
        yield part
    elif isinstance(part, Path):
        fields = vars(part)
        for inner in (fields.get("arg"), fields.get("path"), *(fields.get("args") or ())):
            yield from _iris(inner)
