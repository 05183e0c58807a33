"""Prefixes of a graph: first the prefixes of the user, then the prefixes of the vocabulary that are not yet taken."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph


def prefix_for(name: str, taken: Collection[str]) -> str:
    """Return a prefix that is valid in every format: ``name`` itself if possible, otherwise with a number."""
    legal = name if name[:1].isalpha() and all(_is_legal(sign) for sign in name) else "ns"
    candidates = (legal if number == 1 else f"{legal}-{number}" for number in range(1, len(taken) + 2))
    return next(candidate for candidate in candidates if candidate not in taken)


def bind_prefixes(graph: Graph, user: Mapping[str, str]) -> dict[str, str]:
    """Bind the prefixes of the user and of the vocabulary to a new graph. Return all of them."""
    from rdflib import URIRef

    taken: dict[str, str] = {}
    bound: set[str] = set()
    for name, namespace in [*user.items(), *PREFIXES.items()]:
        if namespace not in bound:
            bound.add(namespace)
            taken[prefix_for(name, taken)] = namespace
    for prefix, namespace in taken.items():
        # Graph.bind also indexes the namespace for serializers, in time proportional to the number of namespaces.
        graph.store.bind(prefix, URIRef(namespace))
    return taken


def user_prefixes(graph: Graph) -> dict[str, str]:
    """Return the prefixes that a graph states. If it states none, return the prefixes with which it was read."""
    from rdflib import URIRef

    stated = {str(name): str(namespace) for namespace, name in graph.subject_objects(URIRef(expand("rbw:prefix")))}
    if not stated:
        known = set(PREFIXES.values())
        stated = {name: str(namespace) for name, namespace in graph.namespaces() if str(namespace) not in known}
    return dict(sorted(stated.items()))


def reading_prefixes(graph: Graph) -> dict[str, str]:
    """Return the prefixes of a graph, and generated prefixes for its other namespaces, so that all names are short.

    Short names matter because the local names of elements select the models of the catalog that simulate them.
    """
    from rdflib import URIRef

    prefixes = user_prefixes(graph)
    for iri in sorted(str(subject) for subject in set(graph.subjects()) if isinstance(subject, URIRef)):
        namespace = iri[: max(iri.rfind("#"), iri.rfind("/")) + 1]
        if namespace and namespace != iri and not iri.startswith(tuple(prefixes.values())):
            prefixes[prefix_for("ns", prefixes)] = namespace
    return prefixes


def _is_legal(sign: str) -> bool:
    return sign in "-_" or (sign.isascii() and sign.isalnum()) or (sign >= "\u00c0" and sign.isalpha())
