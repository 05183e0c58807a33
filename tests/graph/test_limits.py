"""The part of a large structure that is drawn."""

from __future__ import annotations

from robbdd_tools.graph.ask.excerpt import limited
from robbdd_tools.graph.ask.structure import Node, Structure


def structure(stories: int, clauses: int) -> Structure:
    """Stories s0, s1 … with a variant, a template and clauses each (s1.c0 …), which all name one event."""
    found = Structure(events=[Node("event", "event", "event")])
    for number in range(stories):
        story, variant, template = f"s{number}", f"s{number}.v", f"s{number}.t"
        found.stories.append(Node(story, "story", story))
        found.variants.append(Node(variant, "variant", variant))
        found.templates.append(Node(template, "template", template))
        found.links += [(story, variant, ""), (variant, template, "")]
        for index in range(clauses):
            clause = f"s{number}.c{index}"
            found.clauses.append(Node(clause, "then", clause))
            found.links += [(template, clause, ""), (clause, "event", "time")]
    return found


def names(found: Structure) -> set[str]:
    return {node.iri for node in found.nodes()}


def test_a_small_structure_is_whole() -> None:
    whole = structure(2, 3)
    part = limited(whole, len(names(whole)), ["s1.c0"])
    assert (part.structure, part.root) == (whole, None)


def test_of_a_large_one_the_story_around_a_node_is_left_with_its_links() -> None:
    part = limited(structure(5, 3), 10, ["elsewhere", "s3.c1"])
    assert names(part.structure) == {"s3", "s3.v", "s3.t", "s3.c0", "s3.c1", "s3.c2", "event"}
    assert part.root is not None
    assert part.root.iri == "s3"
    assert len(part.structure.links) == 2 + 3 * 2


def test_without_a_node_it_is_the_first_story() -> None:
    part = limited(structure(5, 3), 10, [])
    assert part.root is not None
    assert part.root.iri == "s0"


def test_of_a_story_that_is_too_large_the_template_is_left_then_its_beginning() -> None:
    part = limited(structure(2, 30), 8, ["s1.c2"])
    assert part.root is not None
    assert part.root.iri == "s1.t"
    assert names(part.structure) == {"s1.t", "event", *(f"s1.c{number}" for number in range(6))}
