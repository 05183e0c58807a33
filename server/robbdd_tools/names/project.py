"""The set of files in use. A ``Project`` is mutable and returns immutable ``Snapshot`` objects."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import Unreadable, read_text, too_large, uri_to_path
from robbdd_tools.base.spellings import Spellings
from robbdd_tools.names.analyse import Resolved, analyse, syntax_errors
from robbdd_tools.names.analysis import FileAnalysis, ImportLink
from robbdd_tools.names.import_case import wrong_case
from robbdd_tools.names.imports import missing_package, not_a_path, not_importable, reached_from
from robbdd_tools.names.index import FileIndex, index_file, language_of
from robbdd_tools.names.reachability import Reachability, Source
from robbdd_tools.names.scope import Scope

MAX_RELATED = 20
"""Maximum number of errors in imported files that are linked from one import."""


@dataclass
class Project:
    """Open documents, and files on disk. After every change, the next snapshot is a new revision.

    Several spellings of a URI can name one file. The spelling of an open document represents the file.
    """

    revision: int = 0
    spellings: Spellings = field(default_factory=Spellings)
    _open: dict[str, Source] = field(default_factory=dict[str, Source])
    _disk: dict[str, Source] = field(default_factory=dict[str, Source])
    _analyses: dict[str, Resolved] = field(default_factory=dict[str, Resolved])
    _joined: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])

    def join(self, uri: str, others: Sequence[str]) -> None:
        """Treat other graph files as parts of the graph file ``uri``."""
        self._joined[uri] = tuple(others)
        self.revision += 1

    def open(self, uri: str, version: int, text: str) -> None:
        """Set the text of a document that is open in an editor. This is done when it is opened and on every change."""
        if uri not in self._open:
            for spelling in self.spellings.open(uri):
                self._disk.pop(spelling, None)
        refused = too_large(uri.rsplit("/", 1)[-1], len(text))
        known = self._open.get(uri)
        previous = known if isinstance(known, FileIndex) else None
        self._open[uri] = refused or index_file(Document(uri, version, text), previous)
        self.revision += 1

    def close(self, uri: str) -> None:
        """Use the file on disk instead of the text of the closed document."""
        self._open.pop(uri, None)
        self.spellings.close(uri)
        self.refresh(uri)

    def refresh(self, uri: str) -> None:
        """Drop the cached text of a file that may have changed on disk."""
        for spelling in self.spellings.reset(uri):
            self._disk.pop(spelling, None)
        self.revision += 1

    def texts(self) -> dict[str, tuple[int, str]]:
        """Return the version and the text of every open document."""
        documents = (source.document for source in self._open.values() if isinstance(source, FileIndex))
        return {document.uri: (document.version, document.text) for document in documents}

    def replace(self, texts: Mapping[str, tuple[int, str]]) -> None:
        """Make exactly these documents the open ones, and read all other files again."""
        for uri in [uri for uri in self._open if uri not in texts]:
            del self._open[uri]
        self.spellings.clear()
        for uri in texts:
            self.spellings.open(uri)
        for uri, (version, text) in texts.items():
            known = self._open.get(uri)
            if not isinstance(known, FileIndex) or known.document.text != text:
                self.open(uri, version, text)
        self._disk.clear()

    def has(self, uri: str) -> bool:
        """Return whether a file has been loaded, directly or as an import."""
        spelling = self.spellings.of(uri)
        return spelling in self._open or spelling in self._disk

    def load(self, uri: str) -> Source:
        """Return a file: the text in the editor if it is open, otherwise the file on disk.

        A file on disk is cached until ``refresh``.
        """
        spelling = self.spellings.of(uri)
        if spelling in self._open:
            return self._open[spelling]
        if spelling not in self._disk:
            self._disk[spelling] = _read(spelling)
        return self._disk[spelling]

    def snapshot(self) -> Snapshot:
        """Return the current state of all files and of everything that they import."""
        sources: dict[str, Source] = {}
        waiting = [*self._open, *self._disk]
        while waiting:
            uri = waiting.pop()
            if uri not in sources:
                sources[uri] = source = self._linked(uri, self.load(uri))
                if isinstance(source, FileIndex):
                    waiting += [imported.uri for imported in source.imports]
        return Snapshot(self.revision, sources, self._analyses, dict(self._joined), self.spellings)

    def _linked(self, uri: str, source: Source) -> Source:
        """Return a file whose imports lead to the URIs that represent the imported files."""
        of = self.spellings.of
        if isinstance(source, Unreadable) or all(of(link.written) == link.uri for link in source.imports):
            return source
        imports = tuple(replace(link, uri=of(link.written)) for link in source.imports)
        linked = replace(source, imports=imports)
        (self._open if uri in self._open else self._disk)[uri] = linked
        return linked


def _read(uri: str) -> Source:
    path = uri_to_path(uri)
    if path is None:
        return Unreadable("file-missing", f"'{uri}' is neither open nor a file")
    text = read_text(path)
    return text if isinstance(text, Unreadable) else index_file(Document(uri, 0, text))


@dataclass(frozen=True, eq=False)
class Snapshot:
    """One revision of all files. Analyses are made at the first access, which never changes a result."""

    revision: int
    sources: Mapping[str, Source]
    _analyses: dict[str, Resolved]
    joined: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """URI of a graph file → the other graph files that are its parts."""
    spellings: Spellings = field(default_factory=Spellings)

    @cached_property
    def _files(self) -> dict[str, FileAnalysis]:
        return {}

    @cached_property
    def _scopes(self) -> dict[str, Scope]:
        return {}

    def file(self, uri: str) -> FileAnalysis | None:
        """Return the analysis of a file; ``None`` if it is not in the project or cannot be read."""
        if uri in self._files:
            return self._files[uri]
        if not isinstance(self.sources.get(uri), FileIndex):
            return None
        scope = self.scope(uri)
        kept = self._analyses.get(uri)
        if kept is None or kept.scope != scope:
            imports = self._imports(scope.own)
            kept = analyse(scope, imports, self._on_import_lines(scope.own, imports), kept)
            self._analyses[uri] = kept
        self._files[uri] = kept.analysis
        return kept.analysis

    def document(self, uri: str) -> Document:
        """Return the document of a file.

        It is empty for an unreadable file, so that all positions in it are its start.
        """
        source = self.sources.get(uri)
        return source.document if isinstance(source, FileIndex) else Document(uri, 0, "")

    def unreadable(self, uri: str) -> Unreadable | None:
        """Return the reason why a file cannot be read; ``None`` if it can be read."""
        source = self.sources.get(uri)
        return source if isinstance(source, Unreadable) else None

    def scope(self, uri: str) -> Scope:
        """Return the files whose names a readable file can use, breadth first along its imports."""
        if uri not in self._scopes:
            source = self.sources[uri]
            assert isinstance(source, FileIndex)
            self._scopes[uri] = Scope(source, self.reachability)
        return self._scopes[uri]

    def closure(self, uri: str) -> tuple[FileAnalysis, ...]:
        """Return the analyses of a file and of all its imports: first the file itself, then the nearest imports."""
        found = map(self.file, self.reachability.walk(uri))
        return tuple(analysis for analysis in found if analysis is not None)

    def importers(self, uri: str) -> tuple[str, ...]:
        """Return the files that import a file, directly or indirectly, in alphabetical order."""
        cycle = self.reachability.cycle(uri)
        if cycle[0] not in self._importers:
            self._importers[cycle[0]] = sorted(reached_from(self._users, cycle))
        return tuple(other for other in self._importers[cycle[0]] if other != uri)

    @cached_property
    def _importers(self) -> dict[str, Sequence[str]]:
        """First file of an import cycle → the files of the cycle and the files that import them."""
        return {}

    def is_imported(self, uri: str) -> bool:
        """Return whether another file imports a file."""
        return any(user != uri for user in self._users.get(uri, ()))

    @cached_property
    def _users(self) -> dict[str, list[str]]:
        """The files that import each file directly."""
        users: dict[str, list[str]] = {}
        for name, source in self.sources.items():
            for link in source.imports if isinstance(source, FileIndex) else ():
                users.setdefault(link.uri, []).append(name)
        return users

    @cached_property
    def _faults(self) -> dict[str, list[Related]]:
        """The syntax errors and unusable imports of each file."""
        files = (source for source in self.sources.values() if isinstance(source, FileIndex))
        return {index.document.uri: faults for index in files if (faults := self._faults_of(index))}

    @cached_property
    def _faults_of_cycles(self) -> dict[int, Sequence[Related]]:
        """Number of a large import cycle → the faults that its files reach. All its files reach the same faults."""
        return {}

    @cached_property
    def _leading_to_faults(self) -> frozenset[str]:
        """The files that have faults, and the files that import such a file directly or indirectly."""
        return reached_from(self._users, self._faults)

    @cached_property
    def reachability(self) -> Reachability:
        """The import graph of all files."""
        return Reachability(self.sources)

    def import_each_other(self, one: str, other: str) -> bool:
        """Return whether two files import each other, directly or indirectly."""
        cycles = self.reachability.cycles
        return one in cycles and cycles[one] == cycles.get(other)

    def _imports(self, index: FileIndex) -> tuple[ImportLink, ...]:
        return tuple(ImportLink(link.span, link.uri, self._import_problem(index, link.uri)) for link in index.imports)

    def _on_import_lines(self, index: FileIndex, imports: tuple[ImportLink, ...]) -> list[Diagnostic]:
        uri = index.document.uri
        unusable = [
            Diagnostic(uri, link.span, _import_severity(link), "import", link.problem)
            for link in imports
            if link.problem is not None
        ]
        return unusable + self._misspelled(index, imports) + self._broken_imports(index, imports)

    def _misspelled(self, index: FileIndex, imports: tuple[ImportLink, ...]) -> list[Diagnostic]:
        """Report the imports that only a file system that ignores case can find."""
        found: list[Diagnostic] = []
        for link, path in zip(imports, index.imports, strict=True):
            problem = wrong_case(path, self.spellings) if link.problem is None else None
            if problem is not None:
                found.append(Diagnostic(index.document.uri, link.span, Severity.WARNING, "import", problem))
        return found

    def _import_problem(self, index: FileIndex, uri: str) -> str | None:
        if uri == index.document.uri:
            return "the file imports itself: remove this import"
        problem = (
            not_a_path(uri)
            or not_importable(language_of(index.document.uri), language_of(uri), uri)
            or missing_package(uri)
        )
        if problem is not None:
            return problem
        source = self.sources.get(uri)
        return source.reason if isinstance(source, Unreadable) else None

    def _broken_imports(self, index: FileIndex, imports: tuple[ImportLink, ...]) -> list[Diagnostic]:
        """Report the faults of imported files on the import lines. The places of the faults are linked."""
        found: list[Diagnostic] = []
        for link in imports:
            if link.problem is not None:
                continue
            own = index.document.uri
            faults = self._faults_behind(link.uri)
            # A file in a cycle of imports is among its own imports.
            count = len(faults) - (len(self._faults.get(own, ())) if self.import_each_other(own, link.uri) else 0)
            if count:
                name = link.uri.rsplit("/", 1)[-1]
                others = tuple(islice((fault for fault in faults if fault.uri != own), MAX_RELATED))
                message = f"'{name}' has {_errors(count)}, the first: {others[0].message}"
                found.append(Diagnostic(own, link.span, Severity.ERROR, "broken-import", message, others))
        return found

    def _faults_behind(self, uri: str) -> Sequence[Related]:
        """Return the faults of a file and of all its imports."""
        if uri not in self._leading_to_faults:
            return ()
        scope = self.scope(uri)
        if scope.is_small:
            return [fault for name in scope.uris for fault in self._faults.get(name, ())]
        cycle = self.reachability.cycles[uri]
        if cycle not in self._faults_of_cycles:
            files = filter(scope.reaches, self._faults)
            self._faults_of_cycles[cycle] = [fault for name in files for fault in self._faults[name]]
        return self._faults_of_cycles[cycle]

    def _faults_of(self, index: FileIndex) -> list[Related]:
        faults = [Related(error.uri, error.span, error.message) for error in syntax_errors(index)]
        for link in index.imports:
            problem = self._import_problem(index, link.uri)
            if problem is not None and missing_package(link.uri) is None:
                faults.append(Related(index.document.uri, link.span, problem))
        return faults


def _import_severity(link: ImportLink) -> Severity:
    return Severity.ERROR if missing_package(link.uri) is None else Severity.WARNING


def _errors(count: int) -> str:
    return "an error" if count == 1 else f"{count} errors"
