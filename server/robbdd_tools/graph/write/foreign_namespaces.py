"""Report foreign namespaces that resemble those of the vocabulary (``unknown-namespace``, ``no-criteria``)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.contexts import published_context
from robbdd_tools.graph.rdf.libraries import json_object

if TYPE_CHECKING:
    from rdflib import Graph

    from robbdd_tools.base.document import Document

MAX_NAMED = 3
"""Maximum number of terms in a message."""


def foreign_namespaces(document: Document, graph: Graph) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each unknown namespace that contains terms of the vocabulary.

    If the graph uses no known term at all, yield a single diagnostic that says so.
    """
    from rdflib.namespace import RDF

    found = sorted(_lookalikes(graph).items())
    for namespace, (own, terms) in found:
        yield _unknown(document, namespace, own, sorted(terms))
    known = tuple(PREFIXES[prefix] for prefix in ("bdd", "time", "task", "bhv", "env", "agn", "obs", "rbw"))
    if not found and not any(str(kind).startswith(known) for kind in graph.objects(None, RDF.type)):
        message = "this graph uses no term of the acceptance criteria vocabulary: is it the right file?"
        yield Diagnostic(document.uri, Span(0, 0), Severity.WARNING, "no-criteria", message)


def _lookalikes(graph: Graph) -> dict[str, tuple[str, set[str]]]:
    """Map each unknown namespace to the namespace of the vocabulary with most terms in common, and to these terms."""
    from rdflib.namespace import RDF

    used: dict[str, set[str]] = {}
    known = tuple(PREFIXES.values())
    for term in {*graph.predicates(), *graph.objects(None, RDF.type)}:
        cut = max(str(term).rfind("#"), str(term).rfind("/")) + 1
        if cut and not str(term).startswith(known):
            used.setdefault(str(term)[:cut], set()).add(str(term)[cut:])
    found: dict[str, tuple[str, set[str]]] = {}
    for namespace, terms in used.items():
        fitting = {own: terms & names for own, names in _vocabulary().items()}
        own = max(fitting, key=lambda name: (len(fitting[name]), name))
        # A single word, such as 'Object', may be a term of any vocabulary.
        if len(fitting[own]) > 1:
            found[namespace] = (own, fitting[own])
    return found


@cache
def _vocabulary() -> dict[str, set[str]]:
    """Return the terms of each namespace of the vocabulary."""
    found: dict[str, set[str]] = {}
    for definition in published_context().values():
        name = json_object(definition).get("@id") if isinstance(definition, dict) else definition
        prefix, colon, local = str(name).partition(":")
        if colon and local and prefix in PREFIXES:
            found.setdefault(PREFIXES[prefix], set()).add(local)
    return found


def _unknown(document: Document, namespace: str, own: str, terms: list[str]) -> Diagnostic:
    places = list(_places(document.text, namespace))
    named = ", ".join(f"'{term}'" for term in terms[:MAX_NAMED]) + (" …" if len(terms) > MAX_NAMED else "")
    message = f"the namespace <{namespace}> is unknown, so its terms are ignored ({named}); did you mean <{own}>?"
    fixes: tuple[Fix, ...] = ()
    if places:
        edits = tuple(Edit(document.uri, place, own) for place in places)
        fixes = (Fix(f"Change the namespace to <{own}>", edits),)
    span = places[0] if places else Span(0, 0)
    return Diagnostic(document.uri, span, Severity.WARNING, "unknown-namespace", message, fixes=fixes)


def _places(text: str, namespace: str) -> Iterator[Span]:
    """Yield the spans where a namespace is written as a whole, not as the start of a longer IRI."""
    start = text.find(namespace)
    while start >= 0:
        end = start + len(namespace)
        if text[end : end + 1] in ('"', "'", ">"):
            yield Span(start, end)
        start = text.find(namespace, end)
