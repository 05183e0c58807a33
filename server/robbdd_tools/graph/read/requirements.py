"""Read requirements from a graph: ours, and those that other tools write in the vocabulary of OSLC."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import REQUIREMENT
from robbdd_tools.graph.requirement import Requirement

if TYPE_CHECKING:
    from robbdd_tools.graph.rdf.records import Records

OSLC_REQUIREMENT = "http://open-services.net/ns/rm#Requirement"
"""The class of requirements in OSLC Requirements Management 2.1; ours is a subclass of it."""
DCTERMS = "http://purl.org/dc/terms/"
_TEXT = ("rbw:text", f"{DCTERMS}description", f"{DCTERMS}title")
_IDENTIFIER = ("rbw:identifier", f"{DCTERMS}identifier")
_SOURCE = ("rbw:source", f"{DCTERMS}source")


def read_requirements(records: Records) -> tuple[Requirement, ...]:
    """Return the requirements of a graph in the order of their IRIs, without those that have no text.

    Of several properties that state the same, ours counts; else a description counts before a title.
    """
    nodes = sorted({*records.instances(REQUIREMENT), *records.instances(OSLC_REQUIREMENT)})
    found = (_requirement(records, node) for node in nodes)
    return tuple(one for one in found if one.text)


def requirements_in(text: str, format: str, base: str) -> tuple[Requirement, ...]:
    """Return the requirements that a graph file states. Raises ``UnreadableGraph``."""
    from robbdd_tools.graph.rdf.records import Records
    from robbdd_tools.graph.rdf.serialize import parse

    return read_requirements(Records(parse(text, format, base)))


def _requirement(records: Records, node: str) -> Requirement:
    return Requirement(
        node, _first(records, node, _TEXT), _first(records, node, _IDENTIFIER), _first(records, node, _SOURCE)
    )


def _first(records: Records, node: str, terms: tuple[str, ...]) -> str:
    return next(filter(None, (_value(records, node, term) for term in terms)), "")


def _value(records: Records, node: str, term: str) -> str:
    """Return the value of a property as text; a source may be an IRI."""
    values = records.all(node, term)
    return str(records.value(values[0])).strip() if values else ""
