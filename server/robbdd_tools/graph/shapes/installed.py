"""Load the built-in shapes from files, and generate shapes from the words of the catalog."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.data import data_file
from robbdd_tools.graph.shapes.catalog_words import add_word_shapes

if TYPE_CHECKING:
    from rdflib import Graph

SHAPE_FILES = ("bdd", "time", "behaviour", "scene", "story", "variation", "execution", "study")


@cache
def load_shapes() -> Graph:
    """Return all shapes, read once per process."""
    from rdflib import Graph

    shapes = Graph(bind_namespaces="none")
    for name in SHAPE_FILES:
        shapes.parse(data_file("metamodels", f"shapes/{name}.ttl"), format="turtle")
    add_word_shapes(shapes)
    assign_targets(shapes)
    return shapes


def assign_targets(shapes: Graph) -> None:
    """Detach each property shape from its node shapes, and give it their targets. The result is equivalent.

    pyshacl evaluates a nested shape separately for each focus node, but a shape with targets only once for all targets.
    So this makes validation several times as fast.
    """
    from rdflib.namespace import SH

    targets = (SH.targetClass, SH.targetSubjectsOf, SH.targetObjectsOf)
    for node, shape in list(shapes.subject_objects(SH.property)):
        for kind in targets:
            for target in shapes.objects(node, kind):
                shapes.add((shape, kind, target))
        shapes.remove((node, SH.property, shape))
