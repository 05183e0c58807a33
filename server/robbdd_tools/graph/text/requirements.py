"""Write requirements of a graph, and the links to them, as RobBDD text."""

from __future__ import annotations

from collections.abc import Iterator

from robbdd_tools.graph.rdf.vocabulary import REQUIREMENT, VERIFIES
from robbdd_tools.graph.text.names import Names, indented, quoted


def requirement_texts(names: Names) -> Iterator[str]:
    """Declare the requirements of a graph, and yield the text of each."""
    for node in names.records.instances(REQUIREMENT):
        name = names.declare(node, "requirement")
        stated = (("", "text"), ("id: ", "identifier"), ("source: ", "source"))
        values = ((word, names.records.literal(node, f"rbw:{term}")) for word, term in stated)
        lines = [f"{word}{quoted(str(value))}" for word, value in values if value is not None or not word]
        yield f"Requirement {names.scope_of(node)} {name} {{\n{indented(chr(10).join(lines))}\n}}"


def verified(names: Names, node: str, lead: str) -> str:
    """Return ``lead`` and the requirements that a node verifies as text; empty if there are none."""
    records = names.records
    known = [names.reference(one) for one in records.iris(records.all(node, VERIFIES)) if one in names.paths]
    return f"{lead} {', '.join(known)}" if known else ""
