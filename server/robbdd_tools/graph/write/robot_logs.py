"""Write the logs of real robots that a ``.bddx`` names as triples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import URIRef

    from robbdd_tools.graph.write.sink import Frame

LOG, LOG_TYPE = "rbw:log", "rbw:RobotLog"
PATH, WORLD, ANNOTATIONS = "rbw:log-path", "rbw:world-frame", "rbw:annotations"
VALUES, FRAMES, BASES, JOINTS = "rbw:log-values", "rbw:frame-names", "rbw:base-frames", "rbw:joint-topics"
EVENTS, GRIPS, ERRORS = "rbw:event-signals", "rbw:grip-signals", "rbw:largest-errors"
NAME, STANDS_FOR, SIGNAL, VALUE, SIZE = "rbw:name", "rbw:stands-for", "rbw:signal", "rbw:value", "rbw:size"


def add_log(frame: Frame, root: tree.RobotLog) -> None:
    """Write a ``robot log``. Each of its lists is an RDF list of nodes with a ``rbw:stands-for``, in written order."""
    node = frame.claimed(root.name.text, root.name)
    if node is None:
        return
    frame.sink.add_types(node, [LOG_TYPE], frame.at(root.name))
    for term, text in ((PATH, root.path), (WORLD, root.world), (ANNOTATIONS, root.annotations)):
        if text is not None:
            frame.sink.add(node, term, frame.sink.literal(text.value), frame.at(text))
    for term, mapped in ((FRAMES, root.frames), (BASES, root.bases), (JOINTS, root.joints)):
        _add_list(frame, node, term, NAME, [(one.target.reference, one.text) for one in mapped])
    _add_list(frame, node, VALUES, VALUE, [(one.variable, one.value) for one in root.conditions])
    _add_list(frame, node, EVENTS, SIGNAL, [(one.event, one.signal) for one in root.events])
    _add_list(frame, node, GRIPS, SIGNAL, [(one.agent, one.signal) for one in root.grips])
    errors = [(None if one.target is None else one.target.reference, one.size) for one in root.errors]
    _add_list(frame, node, ERRORS, SIZE, errors)


_Written = tree.Ref | tree.Text | tree.Number | tree.Quantity


def _add_list(
    frame: Frame, node: URIRef, term: str, property_: str, entries: Sequence[tuple[tree.Ref | None, _Written]]
) -> None:
    """Write the entries of a list. Each is what it stands for, if anything, and the value of ``property_``."""
    sink, found = frame.sink, list["URIRef | None"]()
    for number, (reference, written) in enumerate(entries):
        entry = sink.iri(f"{node}.{term.partition(':')[2]}.{number}")
        if entry is not None:
            value = frame.target(written) if isinstance(written, tree.Ref) else sink.value(written)
            sink.add(entry, property_, value, frame.at(written))
            if reference is not None:
                sink.add(entry, STANDS_FOR, frame.target(reference), frame.at(reference))
        found.append(entry)
    if found:
        sink.add(node, term, sink.make_list(found))
