"""Read the elements of an MJCF or URDF file with their places, and of the files that it includes.

Only the text is read: no engine loads it. Size, number and nesting of the files are limited, and entities are refused.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from robbdd_tools.base.files import UnreadableFile
from robbdd_tools.base.limits import MIB, SOURCE_SIZE
from robbdd_tools.base.source_texts import load_source

MAX_FILES = 256
"""Maximum number of files that a model may include."""
MAX_INCLUDED = 32
"""Maximum nesting depth of included files."""


class UnreadableModel(ValueError):
    """The text of a model cannot be read. The message has the file and the line."""


@dataclass(frozen=True, slots=True)
class Element:
    """An element of XML.

    - ``path`` and ``start``: its file, and the offset of its ``<`` in code points.
    - ``parent``: the number of the enclosing element, or -1. The elements of an included file are
      inside the element that includes the file.
    """

    tag: str
    attributes: Mapping[str, str]
    path: Path
    start: int
    parent: int


@dataclass(slots=True)
class _Raw:
    tag: str
    attributes: dict[str, str]
    start: int
    line: int
    parent: int


@dataclass(slots=True)
class ModelReader:
    """Reads a model file with the files that it includes.

    ``files`` are all files that the model names, even missing ones.
    """

    main: Path
    elements: list[Element] = field(default_factory=list[Element])
    files: list[Path] = field(default_factory=list[Path])
    _size: int = 0

    def read(self) -> list[Element]:
        """Return the elements in the order of the text; raises ``UnreadableModel``."""
        self._add(self.main, -1, 0)
        return self.elements

    def _add(self, path: Path, parent: int, depth: int) -> None:
        self.files.append(path)
        numbers: dict[int, int] = {}
        for number, raw in enumerate(self._parsed(path)):
            if depth and number == 0:
                # The root of an included file is no part of the model.
                numbers[0] = parent
                continue
            owner = parent if raw.parent < 0 else numbers[raw.parent]
            numbers[number] = len(self.elements)
            self.elements.append(Element(raw.tag, raw.attributes, path, raw.start, owner))
            if raw.tag == "include" and "file" in raw.attributes:
                self._include(raw, path, owner, depth + 1)

    def _include(self, raw: _Raw, path: Path, owner: int, depth: int) -> None:
        name = raw.attributes["file"]
        where = f"line {raw.line} of '{path.name}' includes '{name}'"
        places = [Path(os.path.normpath(place.parent / name)) for place in (self.main, path)]
        found = next((place for place in places if place.is_file()), None)
        if found is None:
            self.files += places
            raise UnreadableModel(f"{where}, which does not exist")
        if found in self.files:
            raise UnreadableModel(f"{where} a second time")
        if len(self.files) >= MAX_FILES or depth > MAX_INCLUDED:
            raise UnreadableModel(f"{where}: it includes more than {MAX_FILES} files, or nests them too deeply")
        self._add(found, owner, depth)

    def _parsed(self, path: Path) -> list[_Raw]:
        try:
            text = load_source(path)
        except UnreadableFile as error:
            raise UnreadableModel(str(error)) from None
        self._size += len(text)
        if self._size > SOURCE_SIZE.value():
            size = f"{SOURCE_SIZE.value() / MIB:.3g} MiB"
            message = f"the model and the files that it includes are larger than {size}: see {SOURCE_SIZE.variable}"
            raise UnreadableModel(message)
        try:
            return _Parser(text).parse()
        except expat.ExpatError as error:
            reason = expat.errors.messages[error.code] if error.code in expat.errors.messages else str(error)
            raise UnreadableModel(f"line {error.lineno} of '{path.name}' is not XML: {reason}") from None
        except UnreadableModel as error:
            raise UnreadableModel(f"'{path.name}' {error}") from None


class _Parser:
    """Parses one text into its elements."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._data = text.encode("utf-8", "replace")
        self._found: list[_Raw] = []
        self._open: list[int] = []
        self._byte = self._point = 0
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = self._refuse

    def parse(self) -> list[_Raw]:
        self._parser.Parse(self._text, True)
        return self._found

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        parent = self._open[-1] if self._open else -1
        self._open.append(len(self._found))
        self._found.append(_Raw(tag, attributes, self._offset(), self._parser.CurrentLineNumber, parent))

    def _end(self, _: str) -> None:
        self._open.pop()

    def _refuse(self, *_: object) -> None:
        raise UnreadableModel("declares entities, which are not read")

    def _offset(self) -> int:
        """Return the offset of the current element in code points. The parser itself counts UTF-8 bytes."""
        byte = self._parser.CurrentByteIndex
        self._point += len(self._data[self._byte : byte].decode(errors="replace"))
        self._byte = byte
        return self._point
