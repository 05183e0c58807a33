"""Determine the shapes that can be checked on the neighbourhood of one declaration, without the whole graph.

Such a shape starts at the instances of a class and follows properties forwards, so it reaches only nodes that the
declaration uses. A shape needs the whole graph if it has an inverse path, SPARQL or explicit target nodes, or if
several declarations share its nodes. Shapes on user stories also need the whole graph, because scenarios are validated
one by one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.term_prefixes import METAMODELS
from robbdd_tools.graph.rdf.vocabulary import MEMBERSHIPS, expand

if TYPE_CHECKING:
    from rdflib import Graph

_SH = "http://www.w3.org/ns/shacl#"
_FORWARDS = """
targetClass path alternativePath zeroOrMorePath oneOrMorePath zeroOrOnePath property node and or not xone
qualifiedValueShape qualifiedMinCount qualifiedMaxCount qualifiedValueShapesDisjoint class datatype nodeKind minCount
maxCount minExclusive minInclusive maxExclusive maxInclusive minLength maxLength pattern flags languageIn uniqueLang
equals disjoint lessThan lessThanOrEquals closed ignoredProperties hasValue in severity message name description
deactivated order group defaultValue
"""
_COMMON = frozenset(
    [expand(term) for term in ("bdd:ScenarioVariable", "bdd:Set", "bdd:UserStory", "bhv:Behaviour")]
    + [expand(type_) for type_, _, _ in MEMBERSHIPS.values()]
)
_CLASSES = ("http://www.w3.org/2000/01/rdf-schema#Class", "http://www.w3.org/2002/07/owl#Class")


def is_local(shapes: Graph) -> bool:
    """Return whether the findings of some shapes in a declaration depend only on the elements that it uses."""
    from rdflib import URIRef
    from rdflib.namespace import RDF, SH

    terms = {str(term).removeprefix(_SH) for term in shapes.predicates() if str(term).startswith(_SH)}
    classes = {str(target) for target in shapes.objects(None, SH.targetClass)}
    is_implicit = any((None, RDF.type, URIRef(kind)) in shapes for kind in _CLASSES)
    return terms.issubset(_FORWARDS.split()) and not is_implicit and not any(_is_common(name) for name in classes)


def _is_common(name: str) -> bool:
    """Return whether several declarations may describe the instances of a class, or no declaration of the user does."""
    return name in _COMMON or not name.startswith(METAMODELS)
