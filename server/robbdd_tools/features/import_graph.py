"""Import graph of the model files on disk, found without parsing them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.files import FileState, file_state, read_text
from robbdd_tools.base.spellings import Spellings
from robbdd_tools.features.workspace_files import MAX_FILES
from robbdd_tools.names.imports import components, import_uri, reached

# It may match too much (text in comments) but never too little. Candidates are parsed later.
_IMPORT = re.compile(r"\bimport\s*([\"'])(.*?)\1")


@dataclass(frozen=True, slots=True)
class ImportGraph:
    """Maps each file on disk, by URI, to the files that import it directly."""

    users: Mapping[str, frozenset[str]]
    spellings: Spellings = field(default_factory=Spellings)

    @classmethod
    def of(cls, files: Iterable[str]) -> ImportGraph:
        """Build the graph of some files. The imports of a file are cached until the file changes on disk."""
        users: dict[str, set[str]] = {}
        # The files are added first, so that their names on disk represent them, however imports spell these names.
        spellings = Spellings()
        importing = [spellings.of(uri) for uri in files]
        for uri in importing:
            checkpoint()
            for imported in imports_on_disk(uri):
                users.setdefault(spellings.of(imported), set()).add(uri)
        return cls({uri: frozenset(found) for uri, found in users.items()}, spellings)

    def cycles(self) -> Mapping[str, int]:
        """Return a number for each imported file. It is equal for files that import each other, even indirectly."""
        edges = {uri: tuple(users) for uri, users in self.users.items()}
        return components(edges)

    def importers(self, uri: str) -> frozenset[str]:
        """Return the files that import a file, directly or indirectly."""
        return reached(self.users, self.spellings.of(uri))


def imported_on_disk(uris: Iterable[str]) -> frozenset[str]:
    """Return some files on disk together with all files that they import, directly or indirectly."""
    found = set(uris)
    waiting = list(found)
    while waiting:
        checkpoint()
        fresh = imports_on_disk(waiting.pop()) - found
        found |= fresh
        waiting += fresh
    return frozenset(found)


def imports_on_disk(uri: str) -> frozenset[str]:
    """Return the URIs that the import lines of a file on disk name; empty if the file cannot be read."""
    state = file_state(uri)
    return frozenset() if state is None else _imports_of(state)


@lru_cache(maxsize=MAX_FILES)
def _imports_of(state: FileState) -> frozenset[str]:
    text = read_text(state.path)
    found = _IMPORT.finditer(text) if isinstance(text, str) else ()
    return frozenset(import_uri(state.uri, written[2]) for written in found)
