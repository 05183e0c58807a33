"""Read the names that a Python file binds at its top level, with signatures and docstrings. Nothing is executed."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Document
from robbdd_tools.base.files import UnreadableFile
from robbdd_tools.base.source_texts import load_source

if TYPE_CHECKING:
    from robbdd_tools.base.files import FileState

MAX_SIGNATURE = 200
"""Maximum number of characters of a signature."""


@dataclass(frozen=True, slots=True)
class PythonName:
    """A name that a module binds.

    - ``kind``: ``class``, ``function``, ``value`` or ``import``.
    - ``start``, ``end``: the offsets of the name in the file's text, in code points.
    - ``signature``: the parameters in parentheses. For a class, they are the parameters of ``__init__``.
    - ``imported``: for an import, the module (relative ones with leading dots) and the attribute, or ``""`` for the
      module itself.
    """

    name: str
    kind: str
    start: int
    end: int
    signature: str = ""
    doc: str = ""
    imported: tuple[str, str] | None = None


@dataclass(frozen=True, slots=True)
class Outline:
    """The names that a Python file binds at its top level.

    ``is_complete`` is false if other code may bind more: ``from … import *``, ``__getattr__``, ``globals()``. ``error``
    is the syntax error of a file that is not Python, with its line. ``unread`` is the reason why a file was not read.
    """

    names: Mapping[str, PythonName] = field(default_factory=dict[str, PythonName])
    doc: str = ""
    is_complete: bool = True
    error: str = ""
    unread: str = ""


UNKNOWN = Outline(is_complete=False)
"""The outline of a module that is not a Python file."""


@lru_cache(maxsize=32)
def outline(state: FileState) -> Outline:
    """Return the outline of a file. One that is larger than ``SOURCE_SIZE`` is not read."""
    try:
        text = load_source(state.path)
        root = ast.parse(text)
    except SyntaxError as error:
        return Outline(error=f"line {error.lineno}: {error.msg}")
    except (UnreadableFile, ValueError) as error:
        return Outline(is_complete=False, unread=str(error))
    except (RecursionError, MemoryError):
        return Outline(is_complete=False, unread="its expressions are nested too deeply")
    reader = _Reader(text)
    names: dict[str, PythonName] = {}
    for found in reader.bound(root.body):
        names[found.name] = found
    open_ended = {"*", "__getattr__"} & names.keys() or any(_is_dynamic(node) for node in ast.walk(root))
    return Outline(names, _doc(root), is_complete=not open_ended)


def _is_dynamic(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=ast.Name(id="globals" | "exec" | "setattr" | "vars")) | ast.Global():
            return True
        case _:
            return False


class _Reader:
    """Reads the statements of one file."""

    def __init__(self, text: str) -> None:
        # Python and documents end lines at the same characters.
        self._document = Document("", 0, text)

    def bound(self, statements: Iterable[ast.stmt]) -> Iterator[PythonName]:
        """Yield the names that statements bind in their scope."""
        for statement in statements:
            match statement:
                case ast.FunctionDef() | ast.AsyncFunctionDef():
                    yield self._defined(statement, "function", _signature(statement))
                case ast.ClassDef():
                    yield self._defined(statement, "class", _class_signature(statement))
                case ast.Import(names=aliases):
                    yield from (self._imported(alias, None) for alias in aliases)
                case ast.ImportFrom(names=aliases, module=module, level=level):
                    source = "." * level + (module or "")
                    yield from (self._imported(alias, source) for alias in aliases)
                case _:
                    yield from self._targets(statement)

    def _targets(self, statement: ast.stmt) -> Iterator[PythonName]:
        """Yield the names that a statement, or a statement inside it, binds."""
        for child in ast.iter_child_nodes(statement):
            if isinstance(child, ast.stmt):
                yield from self.bound((child,))
            elif isinstance(child, ast.ExceptHandler | ast.match_case):
                yield from self.bound(child.body)
            else:
                for node in ast.walk(child):
                    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                        start = self._offset(node.lineno, node.col_offset)
                        yield PythonName(node.id, "value", start, start + len(node.id))

    def _defined(
        self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef, kind: str, signature: str
    ) -> PythonName:
        begin = self._offset(node.lineno, node.col_offset)
        # The name follows the keywords; a line break between them is possible.
        found = self._document.text.find(node.name, begin + len("def"))
        start = begin if found < 0 else found
        return PythonName(node.name, kind, start, start + len(node.name), signature, _doc(node))

    def _imported(self, alias: ast.alias, source: str | None) -> PythonName:
        name = alias.asname or (alias.name if source is not None else alias.name.partition(".")[0])
        start = self._offset(alias.lineno, alias.col_offset)
        origin = (source, alias.name) if source is not None else (alias.name if alias.asname else name, "")
        return PythonName(name, "import", start, start + len(alias.name), imported=origin)

    def _offset(self, line: int, column: int) -> int:
        """Return the offset of a place in the syntax tree. Its line counts from 1, its column in UTF-8 bytes."""
        text = self._document.line_text(line - 1)
        inside = column if text.isascii() else len(text.encode()[:column].decode(errors="ignore"))
        return self._document.line_starts[line - 1] + inside


def _doc(node: ast.Module | ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) -> str:
    return ast.get_docstring(node) or ""


def _signature(node: ast.FunctionDef | ast.AsyncFunctionDef) -> str:
    returned = "" if node.returns is None else f" -> {_written(node.returns)}"
    return _cut(f"({_written(node.args)}){returned}")


def _class_signature(node: ast.ClassDef) -> str:
    made = next((one for one in node.body if isinstance(one, ast.FunctionDef) and one.name == "__init__"), None)
    if made is None:
        return ""
    _, comma, others = _written(made.args).partition(", ")
    # The first parameter is the object itself.
    return _cut(f"({others})" if comma else "()")


def _written(node: ast.AST) -> str:
    try:
        return ast.unparse(node)
    except (RecursionError, ValueError):
        return "…"


def _cut(words: str) -> str:
    return words if len(words) <= MAX_SIGNATURE else words[: MAX_SIGNATURE - 1] + "…"
