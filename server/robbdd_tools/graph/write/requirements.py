"""Write requirements, and the links to them from the elements that verify them, as triples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import REQUIREMENT, VERIFIES
from robbdd_tools.graph.write.sink import Frame
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import URIRef


def add_requirement(frame: Frame, requirement: tree.Requirement) -> None:
    """Add a requirement with its text, its identifier in other tools and its source."""
    node = frame.claimed(requirement.name.text, requirement.name)
    if node is None:
        return
    frame.sink.add_types(node, [REQUIREMENT], frame.at(requirement.name))
    stated = (("text", requirement.text), ("identifier", requirement.identifier), ("source", requirement.source))
    for term, text in stated:
        if text is not None:
            frame.sink.add(node, f"rbw:{term}", frame.sink.literal(text.value), frame.at(text))


def add_verified(frame: Frame, node: URIRef, requirements: Sequence[tree.Ref]) -> None:
    """Add the requirements that a story, a scenario, a template or a clause verifies."""
    for ref in requirements:
        frame.sink.add(node, VERIFIES, frame.target(ref), frame.at(ref))
