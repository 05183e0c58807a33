"""Complete, describe and find names of Python code in models, by syntax trees. Nothing is imported."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import UnreadableFile, path_to_uri, uri_to_path
from robbdd_tools.base.python_modules import (
    PythonPlace,
    attribute_place,
    find_module,
    module_outline,
    module_place,
    modules_in,
)
from robbdd_tools.base.source_texts import load_source
from robbdd_tools.checks.python_source import code_names
from robbdd_tools.features.markdown import MAX_LINES, code, fenced, literal
from robbdd_tools.features.outside_place import OutsidePlace

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.base.python_modules import PythonPlace
    from robbdd_tools.names.project import Snapshot

_MODULE = re.compile(r"\bpy\s*\{\s*module\s*:\s*\Z")
_ATTRIBUTE = re.compile(r"\bpy\s*\{\s*module\s*:\s*([\w.]+)\s*,\s*attr\s*:\s*\Z")
_RANKS = {"class": 0, "function": 0, "value": 1, "import": 2}
CODE_KINDS = frozenset({"class", "function", "value", "module"})
"""Kinds of completions that name Python code."""


def code_choices(uri: str, before: str, word: str) -> Iterator[tuple[str, str, str, int, str]]:
    """Yield the completions of a name of Python code.

    ``before`` is the text of the declaration up to the word at the cursor, and ``word`` is its typed part. Each
    completion has a label, a kind, a detail, a rank (classes and functions of the module itself first) and
    ``module:attribute``.
    """
    own = uri_to_path(uri)
    if own is None:
        return
    if _MODULE.search(before):
        package, dot, _ = word.rpartition(".")
        for name in modules_in(package, own.parent):
            full = f"{package}{dot}{name}"
            if full != own.stem or dot:
                yield full, "module", "", 0, f"{full}:"
    elif match := _ATTRIBUTE.search(before):
        spec = find_module(match[1], own.parent)
        for name, found in () if spec is None else sorted(module_outline(spec).names.items()):
            if name.isidentifier() and not name.startswith("_"):
                kind = found.kind if found.kind in CODE_KINDS else "value"
                detail = "imported" if found.kind == "import" else found.signature
                yield name, kind, detail, _RANKS[found.kind], f"{match[1]}:{name}"


def describe_code(uri: str, name: str) -> str | None:
    """Describe Python code ``module:attribute`` for a model: its signature and its docstring."""
    module, _, attribute = name.partition(":")
    place = _place(uri, module, attribute)
    return None if place is None else _described(place, module, attribute)


def code_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, str] | None:
    """Return the name of Python code at an offset: its absolute span and ``module:attribute``.

    If the offset is in the module's name, the attribute is empty.
    """
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        if placed.span.contains(offset):
            for source in code_names(placed.declaration):
                for name, attribute in ((source.module, ""), (source.attribute, source.attribute.text)):
                    span = name.span.shifted(placed.offset)
                    if span.contains(offset):
                        return span, f"{source.module.text}:{attribute}"
    return None


def code_definition(uri: str, name: str) -> OutsidePlace | None:
    """Return the place in a Python file that defines ``module:attribute``; its start for a module."""
    module, _, attribute = name.partition(":")
    place = _place(uri, module, attribute)
    if place is None:
        return None
    span = Span(0, 0) if place.name is None else Span(place.name.start, place.name.end)
    return OutsidePlace(path_to_uri(place.path), _text(place.path), span)


def _place(uri: str, module: str, attribute: str) -> PythonPlace | None:
    """Return the place of an attribute as a model finds it; the place of the module if the attribute is empty."""
    own = uri_to_path(uri)
    if own is None:
        return None
    return attribute_place(module, attribute, own.parent) if attribute else module_place(module, own.parent)


def _text(path: Path) -> str:
    try:
        return load_source(path)
    except UnreadableFile:
        return ""


def _described(place: PythonPlace, module: str, attribute: str) -> str:
    name, file = place.name, place.path.name
    if name is None:
        title = f"**module** {code(module if not attribute else f'{module}.{attribute}')}"
        return "\n\n".join(filter(None, (title, _doc(place.outline.doc), _file(file, None))))
    if name.kind in ("class", "function"):
        keyword = "class" if name.kind == "class" else "def"
        title = fenced(f"{keyword} {name.name}{name.signature}", "python")
    else:
        title = f"**{name.kind}** {code(name.name)}"
    line = _text(place.path).count("\n", 0, name.start) + 1
    return "\n\n".join(filter(None, (title, _doc(name.doc), _file(file, line))))


def _file(name: str, line: int | None) -> str:
    return code(name if line is None else f"{name}:{line}")


def _doc(text: str) -> str:
    lines = text.splitlines()
    shown = lines if len(lines) <= MAX_LINES else [*lines[: MAX_LINES - 1], "…"]
    return literal("\n".join(shown))
