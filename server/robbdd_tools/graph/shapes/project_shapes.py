"""The SHACL shapes of a project. Its configuration names their files, which are cached until they change."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import Unreadable, path_to_uri, read_text
from robbdd_tools.graph.project_settings import nearest_setting
from robbdd_tools.graph.rdf.serialize import UnreadableGraph, parse
from robbdd_tools.graph.write.foreign import graph_places

if TYPE_CHECKING:
    from rdflib import Graph

    from robbdd_tools.graph.write.source_map import Location, SourceMap

_SERVICE = re.compile(r"\bSERVICE\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ShapeFile:
    """A file of shapes with the source positions of its nodes. ``faults`` are the reasons why it cannot be used."""

    uri: str
    name: str
    graph: Graph
    places: SourceMap
    faults: tuple[Diagnostic, ...] = ()

    def place(self, shape: str) -> Location | None:
        """Return the source place of a shape in this file."""
        return self.places.node(shape)


@dataclass(frozen=True, slots=True)
class ProjectShapes:
    """The shapes of a model's project.

    ``faults`` are errors in the configuration, placed in its file. ``remarks`` are diagnostics on shapes that no
    configuration file names, placed in the model.
    """

    files: tuple[ShapeFile, ...] = ()
    faults: tuple[Diagnostic, ...] = ()
    remarks: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, slots=True)
class EditorShapes:
    """The file patterns in an editor's setting ``robbdd.shapes``. They are relative to ``folder``."""

    folder: str = ""
    patterns: tuple[str, ...] = ()


def project_shapes(uri: str, editor: EditorShapes | None = None) -> ProjectShapes:
    """Return the shapes that the nearest configuration above a model names, and the shapes that an editor adds.

    The setting is ``shapes = ["shapes/*.ttl"]`` in ``robbdd.toml``, or under ``[tool.robbdd]`` in ``pyproject.toml``.
    Patterns are relative to the folder of the configuration.
    """
    configured = _nearest(uri)
    if editor is None or not editor.patterns:
        return configured
    paths, problems = _matches(Path(editor.folder), editor.patterns)
    known = {file.uri for file in configured.files}
    added = tuple(file for file in map(shape_file, paths) if file.uri not in known)
    message = "the editor's setting 'robbdd.shapes': {}"
    faults = tuple(
        Diagnostic(uri, Span(0, 0), Severity.WARNING, "shapes-unchecked", message.format(problem))
        for problem in problems
    )
    return ProjectShapes(configured.files + added, configured.faults, faults)


def _nearest(uri: str) -> ProjectShapes:
    setting = nearest_setting(uri, "shapes", 'a list of file patterns, such as ["shapes/*.ttl"]')
    if setting is None or setting.faults:
        return ProjectShapes(faults=setting.faults if setting else ())
    paths, problems = _matches(setting.file.parent, setting.values)
    return ProjectShapes(tuple(map(shape_file, paths)), tuple(map(setting.fault, problems)))


def _matches(folder: Path, patterns: Sequence[str]) -> tuple[list[Path], list[str]]:
    """Return the files that match some patterns, each file once, and diagnostics for patterns that cannot be used."""
    paths: dict[Path, None] = {}
    problems: list[str] = []
    for pattern in patterns:
        try:
            matched = sorted(path for path in folder.glob(pattern) if not path.is_dir())
        # pathlib raises NotImplementedError for a pattern that is an absolute path.
        except (ValueError, NotImplementedError, OSError) as error:
            problems.append(f"'{pattern}' is not a file pattern: {error}")
            continue
        if not matched:
            problems.append(f"no file matches the shapes '{pattern}'")
        paths |= dict.fromkeys(matched)
    return list(paths), problems


def shape_file(path: Path) -> ShapeFile:
    """Return a file of shapes, cached until it changes."""
    try:
        state = path.stat()
        return _read(path, state.st_mtime_ns, state.st_size)
    except OSError:
        return _read(path, 0, 0)


@lru_cache(maxsize=64)
def _read(path: Path, _time: int, _size: int) -> ShapeFile:
    from rdflib import Graph

    uri = path_to_uri(path)
    text = read_text(path)
    graph = Graph(bind_namespaces="none")
    faults: list[Diagnostic] = []
    if isinstance(text, Unreadable):
        faults.append(_fault(path, 0, "shapes-syntax", text.reason))
        text = ""
    try:
        graph = parse(text, "ttl", uri)
    except UnreadableGraph as error:
        faults.append(_fault(path, error.offset, "shapes-syntax", str(error)))
    document = Document(uri, 0, text)
    faults += _followed_services(path, document, graph)
    return ShapeFile(uri, path.name, graph, graph_places([document], graph), tuple(faults))


def _followed_services(path: Path, document: Document, graph: Graph) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each SPARQL query in shapes that would contact a server.

    Such queries are rejected because opening a project must not use the network.
    """
    from rdflib.namespace import SH

    for term in (SH.select, SH.ask, SH.construct):
        if any(_SERVICE.search(str(text)) for text in graph.objects(None, term)):
            found = _SERVICE.search(document.text)
            message = "a SPARQL query in a shape can read only this model: SERVICE is not supported"
            yield _fault(path, found.start() if found else 0, "shapes-syntax", message)


def unchecked(uri: str, faults: tuple[Diagnostic, ...]) -> Iterator[Diagnostic]:
    """Yield the faults of shape files, and for each of them a warning at the model that shapes are not checked."""
    yield from faults
    for fault in faults:
        name = fault.uri.rpartition("/")[2]
        related = (Related(fault.uri, fault.span, fault.message),)
        message = f"not all of the project's own shapes are checked: '{name}' cannot be used"
        yield Diagnostic(uri, Span(0, 0), Severity.WARNING, "shapes-unchecked", message, related)


def broken(file: ShapeFile, error: Exception) -> Diagnostic:
    """Return a diagnostic for pyshacl's error on a file of shapes.

    It is placed at the shape that pyshacl names, if any.
    """
    message = str(getattr(error, "message", "") or error).partition("\n")[0]
    names = sorted((key[0] for key in file.places.places if len(key) == 1 and key[0] in message), key=len)
    place = file.place(names[-1]) if names else None
    span = Span(0, 0) if place is None else place.span
    return Diagnostic(file.uri, span, Severity.ERROR, "shapes-syntax", f"these shapes cannot be used: {message}")


def _fault(path: Path, offset: int, code: str, message: str) -> Diagnostic:
    return Diagnostic(path_to_uri(path), Span(offset, offset), Severity.ERROR, code, message)
