"""Read the logs of real robots that executions name into plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import QuantityError, read_quantity
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.write import robot_logs as terms
from robbdd_tools.protocol.recorded_log import ERROR_KEYS, RecordedLog

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import Iri
    from robbdd_tools.graph.read.instances import Places


def read_log_of(records: Records, execution: Iri, places: Places) -> RecordedLog | None:
    """Return the log of an execution; ``None`` if it names none, or one without a path."""
    node = next(iter(records.iris(records.all(execution, terms.LOG))), None)
    path = "" if node is None else records.text(node, terms.PATH)
    if node is None or not path:
        return None

    def pairs(term: str, property_: str = terms.NAME) -> Iterator[tuple[str, str]]:
        for entry in _items(records, node, term):
            named = records.iris(records.all(entry, terms.STANDS_FOR))
            yield records.text(entry, property_), named[0] if named else ""

    values = ((meant, _value(records, entry)) for entry, meant in _entries(records, node))
    return RecordedLog(
        node,
        path,
        tuple(values),
        tuple(pairs(terms.FRAMES)),
        tuple(pairs(terms.BASES)),
        records.text(node, terms.WORLD),
        tuple(pairs(terms.JOINTS)),
        tuple((event, signal) for signal, event in pairs(terms.EVENTS, terms.SIGNAL)),
        tuple((agent, signal) for signal, agent in pairs(terms.GRIPS, terms.SIGNAL)),
        records.text(node, terms.ANNOTATIONS),
        tuple(_errors(pairs(terms.ERRORS, terms.SIZE))),
        places(node),
    )


def _items(records: Records, node: Iri, term: str) -> tuple[Iri, ...]:
    """Return the entries of a list; none if the log does not have it."""
    try:
        return records.iris(records.list_of(node, term))
    except Incomplete:
        return ()


def _entries(records: Records, node: Iri) -> Iterator[tuple[Iri, str]]:
    for entry in _items(records, node, terms.VALUES):
        try:
            yield entry, records.one(entry, terms.STANDS_FOR)
        except Incomplete:
            continue


def _value(records: Records, entry: Iri) -> str | float:
    return next((records.value(found) for found in records.all(entry, terms.VALUE)), "")


def _errors(sizes: Iterator[tuple[str, str]]) -> Iterator[tuple[str, float]]:
    """Yield the errors in SI units. One that is no length, angle or speed is left out: a check reports it."""
    for size, element in sizes:
        for dimension, key in ERROR_KEYS.items():
            try:
                yield element or key, read_quantity(size, dimension).si
            except QuantityError:
                continue
