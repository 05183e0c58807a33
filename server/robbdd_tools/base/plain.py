"""Frozen dataclasses from the JSON that they were written as."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

Kind = TypeVar("Kind")


def from_plain(kind: type[Kind], data: object) -> Kind:
    """Return a dataclass made of its fields as JSON gives them; raises ``TypeError`` or ``KeyError`` for others.

    Fields may be plain values, dataclasses, tuples and mappings of these, and any of them or ``None``.
    """
    return cast(Kind, _value(kind, data))


def _value(kind: Any, data: Any) -> Any:
    origin, inner = get_origin(kind), get_args(kind)
    if is_dataclass(kind):
        hints = _hints(kind)
        return cast(Any, kind)(**{name: _value(hints[name], value) for name, value in data.items()})
    if origin in (UnionType, Union):
        if data is None:
            return None
        kinds = [one for one in inner if one is not type(None)]
        listed = [one for one in kinds if get_origin(one) is tuple] if isinstance(data, list) else []
        return _value((listed or kinds)[0], data)
    if origin is tuple:
        kinds = [inner[0]] * len(data) if inner[-1] is Ellipsis else inner
        return tuple(_value(one, value) for one, value in zip(kinds, data, strict=True))
    if origin is not None and issubclass(origin, Mapping):
        return {key: _value(inner[1], value) for key, value in data.items()}
    return data


@cache
def _hints(kind: Any) -> dict[str, Any]:
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind)}
