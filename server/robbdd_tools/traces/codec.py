"""Encode traces as bytes and decode them, bit for bit; works for any dataclass fields."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass, replace
from typing import Any, cast

import numpy as np

from robbdd_tools.base.articulation import OpeningRecord
from robbdd_tools.catalog.api import Region
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.judge import Regions
from robbdd_tools.monitor.trace import Doubt, EventStamp, Trace


@dataclass(frozen=True, slots=True)
class Evidence:
    """Data that clauses are judged on: a trace, and the regions of its scene's workspaces."""

    trace: Trace
    regions: Regions


PART = 1 << 18
"""This many numbers are encoded at once."""
KINDS: Mapping[str, Any] = {
    kind.__name__: kind for kind in (Evidence, Trace, Contact, Doubt, EventStamp, Region, OpeningRecord)
}
"""The dataclasses that a trace may contain; others cannot be restored."""


def pack(evidence: Evidence) -> bytes:
    """Return the bytes of ``pack_parts``; raises ``TypeError`` likewise."""
    return b"".join(pack_parts(evidence))


def pack_parts(evidence: Evidence) -> Iterator[bytes]:
    """Yield the bytes of a trace in parts, so that a long trace is never in memory as bytes.

    They are the length (8 bytes, little-endian) of a JSON description, the description, and the arrays one after
    another. Raises ``TypeError`` for a value that could not be restored.
    """
    arrays: list[np.ndarray[Any, Any]] = []
    head = json.dumps(_described(evidence, arrays), ensure_ascii=False).encode()
    yield len(head).to_bytes(8, "little") + head
    for array in arrays:
        # Time is the fastest index: the many constant series then compress to almost nothing.
        for index in np.ndindex(array.shape[:0:-1]):
            series = array[(slice(None), *index[::-1])] if array.ndim else array
            for first in range(0, len(series) if array.ndim else 1, PART):
                yield (series[first : first + PART] if array.ndim else series).tobytes()


def unpack(data: bytes) -> Evidence:
    """Decode the bytes of ``pack``; raises ``ValueError``, ``KeyError`` or ``TypeError`` for other bytes."""
    start = 8 + int.from_bytes(data[:8], "little")
    found = _restored(json.loads(data[8:start]), _Arrays(data, start))
    if not isinstance(found, Evidence):
        raise TypeError("these bytes contain no trace")
    return found


class _Arrays:
    """Reads arrays one after another."""

    def __init__(self, data: bytes, start: int) -> None:
        self._data = data
        self._next = start

    def take(self, kind: str, shape: list[int]) -> np.ndarray[Any, Any]:
        size = int(np.prod(shape))
        found = np.frombuffer(self._data, np.dtype(kind), size, self._next)
        self._next += found.nbytes
        return np.ascontiguousarray(found.reshape(shape, order="F"))


def _described(value: Any, arrays: list[np.ndarray[Any, Any]]) -> Any:
    if isinstance(value, np.ndarray):
        array = cast("np.ndarray[Any, Any]", value)
        little = array.astype(array.dtype.newbyteorder("<"), copy=False)
        arrays.append(little)
        return {"array": little.dtype.str, "shape": list(little.shape)}
    if is_dataclass(value) and not isinstance(value, type):
        name = type(value).__name__
        if KINDS.get(name) is not type(value):
            raise TypeError(f"a {name} in a trace cannot be stored")
        return {"kind": name, "fields": {f.name: _described(getattr(value, f.name), arrays) for f in fields(value)}}
    if isinstance(value, Mapping):
        entries = cast(Mapping[Any, Any], value).items()
        return {"map": [[_described(key, arrays), _described(inner, arrays)] for key, inner in entries]}
    if isinstance(value, tuple | list):
        return {"tuple": [_described(inner, arrays) for inner in cast(tuple[Any, ...], value)]}
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise TypeError(f"a {type(value).__name__} in a trace cannot be stored")


def _restored(value: Any, arrays: _Arrays) -> Any:
    match value:
        case {"array": kind, "shape": shape}:
            return arrays.take(kind, shape)
        case {"kind": name, "fields": entries}:
            missing = [field for field in fields(KINDS[name]) if field.name not in entries]
            if len(entries) + len(missing) != len(fields(KINDS[name])) or not all(map(_is_optional, missing)):
                raise TypeError(f"this {name} was written by another version")
            found = KINDS[name](**{field: _restored(inner, arrays) for field, inner in entries.items()})
            return _completed(found) if name == "Trace" and "immovable" not in entries else found
        case {"map": entries}:
            return {_restored(key, arrays): _restored(inner, arrays) for key, inner in entries}
        case {"tuple": entries}:
            return tuple(_restored(inner, arrays) for inner in entries)
        case _:
            return value


def _is_optional(field: Field[Any]) -> bool:
    return field.default is not MISSING or field.default_factory is not MISSING


def _completed(trace: Trace) -> Trace:
    """Add the immovable elements to an older trace: elements with configurations but without a mass.

    The trace's contact forces cannot be reconstructed, so clauses judged by force are unknown.
    """
    elements = {element for element, _ in trace.settings}
    immovable = (name for name in trace.names if name in elements and (name, "mass") not in trace.settings)
    return replace(trace, immovable=tuple(immovable))
