"""Read frozen dataclasses from JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from math import isfinite
from types import UnionType
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

Kind = TypeVar("Kind")
_SCALARS = (bool, int, float, str)


def from_plain(kind: type[Kind], data: object) -> Kind:
    """Return the dataclass that JSON data describes. Raises ``TypeError``, ``ValueError`` or ``KeyError``.

    Fields may be plain values, dataclasses, and tuples and mappings of these. Each of them may be optional (``None``).
    A value of the wrong type is refused, but an integer is accepted for a float.
    """
    return cast(Kind, _value(kind, data))


def finite(number: str) -> float:
    """Return a JSON number as a float. Raises ``ValueError`` for infinity and ``NaN``."""
    value = float(number)
    if not isfinite(value):
        raise ValueError(number)
    return value


def _value(kind: Any, data: Any) -> Any:
    origin, inner = get_origin(kind), get_args(kind)
    if kind in _SCALARS:
        accepted = (int, float) if kind is float else kind
        is_other_bool = isinstance(data, bool) and kind is not bool
        _expect(isinstance(data, accepted) and not is_other_bool, data, kind.__name__)
        return data
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
        _expect(isinstance(data, list | tuple), data, "list")
        kinds = [inner[0]] * len(data) if inner[-1] is Ellipsis else inner
        return tuple(_value(one, value) for one, value in zip(kinds, data, strict=True))
    if origin is not None and issubclass(origin, Mapping):
        _expect(isinstance(data, Mapping), data, "mapping")
        return {key: _value(inner[1], value) for key, value in data.items()}
    return data


def _expect(is_fitting: bool, data: object, name: str) -> None:
    if not is_fitting:
        raise TypeError(f"{data!r} is no {name}")


@cache
def _hints(kind: Any) -> dict[str, Any]:
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind)}
