"""The quick fix that gives a first pose to an object from a file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.project import Snapshot

POSITION = "(0.5, 0, 0.1) m"
"""On the catalog's table, in front of an arm at its usual place; world frame."""
_GRAPH, _ROOM, _ORIGIN = "poses", "room", "origin"


def first_pose(snapshot: Snapshot, uri: str, start: int) -> Iterator[Fix]:
    """Yield the fix that places an element whose name begins at an offset of a ``.scenex``, if it can be made.

    The element has one model.
    """
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        root = placed.declaration.tree
        for entry in root.entries if isinstance(root, tree.SceneInstance) else ():
            if isinstance(entry, tree.Modelled) and entry.reference.span.start + placed.offset == start:
                yield from _placing(snapshot, uri, placed, entry)


def _placing(snapshot: Snapshot, uri: str, placed: PlacedDeclaration, element: tree.Modelled) -> Iterator[Fix]:
    scene = placed.declaration.tree
    models = [one for one in element.entries if isinstance(one, tree.Model)]
    if len(models) != 1 or not isinstance(scene, tree.SceneInstance):
        return
    document = snapshot.document(uri)
    text, offset = document.text, placed.offset
    name = element.reference.path.rpartition(".")[2]
    graph = next((one for one in scene.entries if isinstance(one, tree.Graph)), None)
    bodies = [] if graph is None else [one for one in graph.entries if isinstance(one, tree.RigidBody)]
    frame = f"{_ROOM}.{_ORIGIN}" if graph is None else _fixed_frame(bodies)
    if frame is None or name in (_ROOM, *(one.name.text for one in bodies)):
        return
    body = (
        f"body {name} {{",
        "    frame base {",
        f"        pose {name}_in_room {{",
        f"            wrt: <{frame}>",
        f"            xyz: {POSITION}",
        "            orientation: quat { xyzw: (0, 0, 0, 1) }",
        "        }",
        "    }",
        "}",
    )
    if graph is None:
        line = document.line_starts[document.position(element.span.start + offset).line]
        indent = _indent(text, element.span.start + offset)
        room = f"body {_ROOM} {{ frame {_ORIGIN} {{ }} }}"
        namespace = text[scene.namespace.span.start + offset : scene.namespace.span.end + offset]
        inner = "".join(f"{indent}    {part}\n" for part in (room, *body))
        added = Edit(uri, Span(line, line), f"{indent}kgraph {namespace} {_GRAPH} {{\n{inner}{indent}}}\n")
        graph_name = _GRAPH
    else:
        end = bodies[-1].span.end + offset
        indent = _indent(text, bodies[-1].span.start + offset)
        added = Edit(uri, Span(end, end), "".join(f"\n{indent}{part}" for part in body))
        graph_name = graph.name.text
    source = models[0].source.span.end + offset
    mapped = Edit(uri, Span(source, source), f" map body <{graph_name}.{name}>")
    yield Fix(f"Place '{name}' on the catalog's table, to be moved from there", (added, mapped))


def _fixed_frame(bodies: list[tree.RigidBody]) -> str | None:
    """Return the path of the first frame without a pose, which the others are placed relative to."""
    for body in bodies:
        for frame in body.parts:
            if isinstance(frame, tree.Frame) and not frame.poses:
                return f"{body.name.text}.{frame.name.text}"
    return None


def _indent(text: str, offset: int) -> str:
    """Return the white space at the beginning of the line of an offset."""
    line = text[text.rfind("\n", 0, offset) + 1 :]
    return line[: len(line) - len(line.lstrip(" \t"))]
