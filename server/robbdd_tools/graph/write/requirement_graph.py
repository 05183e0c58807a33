"""Write requirements as a graph that other tools read, too: in our vocabulary and in that of OSLC."""

from __future__ import annotations

from collections.abc import Iterable

from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.rdf.vocabulary import REQUIREMENT, expand
from robbdd_tools.graph.read.requirements import DCTERMS, OSLC_REQUIREMENT
from robbdd_tools.graph.requirement import Requirement


def requirement_graph(found: Iterable[tuple[str, Requirement]], format: str) -> str:
    """Return requirements, each with its name, as a graph in a format of ``serialize``. Raises ``UnwritableGraph``."""
    from rdflib import Graph, Literal, URIRef
    from rdflib.namespace import RDF

    graph = Graph("SimpleMemory", bind_namespaces="none")
    for prefix, namespace in (("dcterms", DCTERMS), ("oslc_rm", OSLC_REQUIREMENT.removesuffix("Requirement"))):
        graph.bind(prefix, namespace)
    for name, one in found:
        node = URIRef(one.iri)
        for kind in (REQUIREMENT, OSLC_REQUIREMENT):
            graph.add((node, RDF.type, URIRef(expand(kind))))
        stated = (
            ("rbw:text", one.text),
            ("rbw:identifier", one.identifier),
            ("rbw:source", one.source),
            (f"{DCTERMS}identifier", one.identifier or name),
            (f"{DCTERMS}description", one.text),
            (f"{DCTERMS}source", one.source),
        )
        for term, value in stated:
            if value:
                graph.add((node, URIRef(expand(term)), Literal(value)))
    return serialize(graph, format)
