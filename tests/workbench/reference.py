"""Writes ``docs/python-reference.md`` from the docstrings: ``.venv/bin/python tests/workbench/reference.py``.

The page lists every public name with its signature, so a test that compares it with the code notices each change.
"""

from __future__ import annotations

import dataclasses
import enum
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import robbdd_tools

PAGE = Path(__file__).parents[2] / "docs" / "python-reference.md"
HEAD = """# Python reference

The public names of `robbdd_tools`, made from the docstrings by `tests/workbench/reference.py`.
[python.md](python.md) shows how to use them. Members that are not listed here are internal.
"""
PROTOCOL = ("__enter__", "__iter__", "__aenter__", "__aiter__", "__len__")
"""Methods that are part of an interface although their names begin with an underscore."""

COMMON_TYPES = {
    "Any", "AsyncIterator", "False", "FloatArray", "Iterator", "Mapping", "None", "Path", "PathLike", "Self",
    "Sequence", "True",
}  # fmt: skip
"""Types and constants by others that public signatures may mention; a member with any other type is internal."""
QUOTED = re.compile(r"(: |-> )'([^']*)'")


def page() -> str:
    """Return the text of the page."""
    entries = ((name, getattr(robbdd_tools, name)) for name in robbdd_tools.__all__)
    return "\n".join([HEAD, *(line for name, thing in entries for line in _entry(name, thing))])


def _entry(name: str, thing: Any) -> Iterator[str]:
    if not inspect.isclass(thing):
        yield from _described(f"## `{name}{_signature(thing)}`", thing)
        return
    bases = [base.__name__ for base in thing.__bases__ if issubclass(base, (Exception, enum.Enum))]
    derived = f"({', '.join(bases)})" if bases else ""
    yield from _described(f"## class `{name}{derived}`", thing)
    fields = list(_fields(thing))
    if fields:
        yield from (*fields, "")
    for member in _members(thing):
        yield from _described(*member)


def _fields(owner: type[Any]) -> Iterator[str]:
    if issubclass(owner, enum.Enum):
        yield from (f"- `{member.name}` = `{member.value!r}`" for member in owner)
    elif dataclasses.is_dataclass(owner):
        yield from (f"- `{field.name}: {field.type}`" for field in dataclasses.fields(owner) if _is_public(field.type))


def _members(owner: type[Any]) -> Iterator[tuple[str, Any]]:
    names: dict[str, None] = {}
    for base in reversed(owner.__mro__):
        if base.__module__.startswith("robbdd_tools"):
            names |= dict.fromkeys(vars(base))
    for name in names:
        member = inspect.getattr_static(owner, name)
        if name.startswith("_") and name not in PROTOCOL:
            continue
        found = getattr(owner, name)
        if inspect.isfunction(member) or isinstance(member, (classmethod, staticmethod)):
            signature = _signature(found)
        else:
            getter = member.fget if isinstance(member, property) else getattr(member, "func", None)
            signature = "" if getter is None else f": {getter.__annotations__['return']}"
        if signature and _is_public(signature):
            yield f"### `{owner.__name__}.{name}{signature}`", found if inspect.isroutine(found) else member


def _signature(function: Any) -> str:
    return QUOTED.sub(r"\1\2", str(inspect.signature(function)))


def _is_public(types: object) -> bool:
    """Whether a signature or annotation mentions public types only."""
    return {*re.findall(r"\b[A-Z]\w*", str(types))} <= {*robbdd_tools.__all__, *COMMON_TYPES}


def _described(heading: str, thing: Any) -> Iterator[str]:
    text = inspect.getdoc(thing) or ""
    yield from (heading, "", *([text.replace("``", "`"), ""] if text else []))


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
