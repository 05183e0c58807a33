"""Quick fixes of diagnostics about other files: missing imports, missing models and cyclic imports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, NewFile
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.stored_names import without_case
from robbdd_tools.checks.finding import MAX_OFFERED
from robbdd_tools.checks.lines import import_removal
from robbdd_tools.features.quoted_completion import MODEL_ENDINGS
from robbdd_tools.features.workspace_files import files_near
from robbdd_tools.names.imports import import_path, not_importable, reached
from robbdd_tools.names.index import FileIndex, language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, ImportLink
    from robbdd_tools.names.project import Snapshot

MIN_ALIKE = 0.6
"""Minimum similarity of a suggested file name."""
_EMPTY_MODELS: Mapping[str, str] = {
    "mjcf": '<mujoco model="{name}">\n  <worldbody/>\n</mujoco>\n',
    "urdf": '<robot name="{name}">\n  <link name="base"/>\n</robot>\n',
    "usd": "#usda 1.0\n",
}


def import_fixes(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield fixes for an import that cannot be resolved.

    They replace the path by a similar one or create the missing file. For an import of the file itself or of a file of
    the wrong kind, they remove the import.
    """
    link = _link(file, diagnostic.span)
    if link is None:
        return
    uri, span = file.document.uri, diagnostic.span
    language = language_of(uri)

    def is_importable(other: str) -> bool:
        return not_importable(language, language_of(other), other) is None

    if link.uri == uri or (not is_importable(link.uri) and uri_to_path(link.uri) is not None):
        yield from import_removal(file, link, "Remove this import")
        return
    near = (found for found in files_near(uri, is_importable) if found != uri)
    written = file.document.text[span.start : span.end]
    for path in _alike(written, uri, near):
        yield Fix(f"Change to '{path}'", (Edit(uri, span, path),))
    unreadable = snapshot.unreadable(link.uri)
    if unreadable is not None and unreadable.code == "file-missing" and uri_to_path(link.uri) is not None:
        yield Fix(f"Create '{written}'", (), NewFile(link.uri, ""))


def model_file_fixes(_: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield fixes for a missing model file: similar paths, and the creation of an empty model at the missing path."""
    uri, own = file.document.uri, uri_to_path(file.document.uri)
    model = _model(file, diagnostic.span)
    if model is None or own is None:
        return
    (path, kinds), endings = model, frozenset[str]().union(*(MODEL_ENDINGS[kind] for kind in model[1]))
    quote = file.document.text[diagnostic.span.start]
    for found in _alike(path, uri, files_near(uri, lambda name: Path(name).suffix.lower() in endings)):
        yield Fix(f"Change to '{found}'", (Edit(uri, diagnostic.span, f"{quote}{found}{quote}"),))
    place = own.parent / path
    if len(kinds) == 1 and place.suffix.lower() in endings and not place.exists() and not path.startswith("~"):
        text = _EMPTY_MODELS[kinds[0]].format(name=place.stem)
        yield Fix(f"Create '{path}' with an empty model", (), NewFile(path_to_uri(place), text))


def cycle_fixes(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield fixes for an import cycle. Each removes an import that is not needed.

    The import is the reported one, or one by which another file in the cycle imports this file again.
    """
    link = _link(file, diagnostic.span)
    if link is None:
        return
    if _is_needless(snapshot, file.document.uri, link.uri):
        yield from import_removal(file, link, "Remove this import, which is not needed")
    own = file.document.uri
    for other in snapshot.closure(link.uri):
        for back in other.imports:
            uri = other.document.uri
            if back.uri == own != uri and _is_needless(snapshot, uri, own):
                title = f"Remove the import of '{_name(own)}' from '{_name(uri)}', which does not need it"
                yield from import_removal(other, back, title)


def _is_needless(snapshot: Snapshot, importer: str, imported: str) -> bool:
    """Return whether an import is not needed.

    It is not needed if the file and the files that import it can still access everything that they use without it.
    """
    edges = {
        uri: [link.uri for link in source.imports if (uri, link.uri) != (importer, imported)]
        for uri, source in snapshot.sources.items()
        if isinstance(source, FileIndex)
    }
    for uri in (importer, *snapshot.importers(importer)):
        file = snapshot.file(uri)
        left = {uri, *reached(edges, uri)}
        for placed in file.declarations if file is not None else ():
            if any(target not in left for target, _, _ in placed.targets.declarations()):
                return False
    return True


def _link(file: FileAnalysis, span: Span) -> ImportLink | None:
    return next((link for link in file.imports if link.span == span), None)


def _model(file: FileAnalysis, span: Span) -> tuple[str, tuple[str, ...]] | None:
    """Return the path of the model file at a span, and the formats that it may have: two for a mounted gripper."""
    for placed in file.declarations:
        root = placed.declaration.tree
        nodes = walk(root) if root is not None and placed.span.contains(span.start) else ()
        for node in nodes:
            if not isinstance(node, tree.Model):
                continue
            gripper = None if node.gripper is None else node.gripper.source
            for source, kinds in ((node.source, (node.kind,)), (gripper, ("mjcf", "urdf"))):
                if isinstance(source, tree.SystemPath) and source.path.span.shifted(placed.offset) == span:
                    return source.path.value, kinds
    return None


def _alike(written: str, uri: str, files: Iterable[str]) -> Iterator[str]:
    """Yield the relative paths of files whose names are similar to the written one."""
    paths = sorted(path for found in files if (path := import_path(uri, found)) is not None)
    paths.sort(key=lambda path: without_case(path) != without_case(written))
    stems = list(dict.fromkeys(map(_stem, paths)))
    for stem in get_close_matches(_stem(written), stems, n=MAX_OFFERED, cutoff=MIN_ALIKE):
        yield from (path for path in paths if _stem(path) == stem and path != written)


def _stem(path: str) -> str:
    """Return the name of a file without folder, extension, and upper case letters."""
    return without_case(_name(path).partition(".")[0])


def _name(path: str) -> str:
    return path.rpartition("/")[2]
