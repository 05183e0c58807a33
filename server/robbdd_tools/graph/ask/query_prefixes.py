"""Determine the meaning of a query's prefixes.

This is necessary because a model's own prefix may have the name of a prefix of the vocabulary (``bdd``, ``env``).
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.prefixes import prefix_for, user_prefixes

if TYPE_CHECKING:
    from rdflib import Graph

_MORE_PREFIXES = {
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "owl": "http://www.w3.org/2002/07/owl#",
    "sh": "http://www.w3.org/ns/shacl#",
}


def query_prefixes(graph: Graph, text: str) -> tuple[dict[str, str], list[str]]:
    """Return the prefixes of a query, and a remark on each prefix that may have an unexpected meaning.

    A prefix may belong both to the model and to the vocabulary. It then means the model's namespace, unless the query
    uses it only for terms of the vocabulary.
    """
    own = user_prefixes(graph)
    taken: dict[str, str] = {}
    later: dict[str, str] = {}
    remarks: list[str] = []
    for name, namespace in own.items():
        vocabulary = PREFIXES.get(name, namespace)
        in_model, in_vocabulary = (_uses(graph, text, name, start) for start in (namespace, vocabulary))
        if vocabulary != namespace and in_vocabulary and not in_model:
            taken[name] = vocabulary
            later[name] = namespace
        elif namespace not in taken.values():
            taken[prefix_for(name, taken)] = namespace
            if vocabulary != namespace and in_vocabulary:
                remarks.append(f"'{name}:' means this model's <{namespace}>, not the vocabulary's <{vocabulary}>")
    for name, namespace in [*PREFIXES.items(), *_MORE_PREFIXES.items()]:
        if namespace not in taken.values():
            taken[prefix_for(name, taken)] = namespace
    for name, namespace in later.items():
        free = prefix_for(name, taken)
        taken[free] = namespace
        remarks.append(f"'{name}:' means the vocabulary's <{taken[name]}>; this model's <{namespace}> is '{free}:'")
    return taken, remarks


def _uses(graph: Graph, text: str, prefix: str, namespace: str) -> bool:
    """Return whether a query writes an existing term of a namespace with a prefix that the query does not declare."""
    from rdflib import URIRef

    if re.search(rf"\bPREFIX\s+{re.escape(prefix)}\s*:", text, re.IGNORECASE):
        return False
    names = re.findall(rf"(?<![\w.\-<:?$]){re.escape(prefix)}:([\w\-]+)", text)
    terms = (URIRef(namespace + name) for name in names)
    return any(
        (term, None, None) in graph or (None, term, None) in graph or (None, None, term) in graph for term in terms
    )
