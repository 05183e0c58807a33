"""Resolve the paths of imports, and define which kinds of file may import which other kinds."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from importlib.machinery import PathFinder
from pathlib import Path
from urllib.parse import quote, unquote, urljoin, urlsplit

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.graph_formats import GRAPH_FORMATS, graph_format
from robbdd_tools.base.uris import drive_uri

IMPORTABLE: Mapping[str, tuple[str, ...]] = {
    "scene": ("scene",),
    "bdd": ("bdd", "scene"),
    "ktree": ("ktree",),
    "scenex": ("ktree", "scene", "scenex"),
    "bddx": ("bdd", "scenex"),
    "study": ("bdd", "bddx", "scenex"),
}
"""The kinds of model file that each kind may import."""
_ENRICHED = frozenset({"scene", "bdd", "scenex"})
"""The kinds of file that may import graphs. Such a graph adds properties to elements that are declared elsewhere."""
BACKSLASH = "\\"
_PACKAGE = "package:"
_ADDRESS = "address:"
# URLs, and network paths in the notation of Windows or of URLs.
_ADDRESSES = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*://|file:|//|\\\\")


def import_uri(importer: str, path: str) -> str:
    """Return the URI of an import's path, which is relative to the importing file or has the form ``package:path``.

    If the package is not installed, the URI is one that ``missing_package`` recognises. For a network path, a URL or a
    path with backslashes, the URI is one that ``not_a_path`` recognises, and nothing is read from there.
    """
    if _ADDRESSES.match(path) or BACKSLASH in path:
        return f"{_ADDRESS}{quote(path, errors='surrogatepass')}"
    drive = drive_uri(path)
    if drive is not None:
        return drive
    package, colon, inside = path.partition(":")
    # Only the package's path is looked up, because its code must not run. A single letter is a drive, not a package.
    if not colon or not package.isidentifier() or len(package) == 1 or inside.startswith("//"):
        return urljoin(importer, quote(path, errors="surrogatepass"))
    folder = _package_folder(package)
    if folder is None:
        return f"{_PACKAGE}{quote(package)}/{quote(inside, errors='surrogatepass')}"
    return path_to_uri(folder / inside.lstrip("/"))


@lru_cache(maxsize=10_000)
def import_path(importer: str, imported: str) -> str | None:
    """Return the path by which one file imports another, relative to the importing file; ``None`` if there is none."""
    here, there = urlsplit(importer), urlsplit(imported)
    if (here.scheme, here.netloc) != (there.scheme, there.netloc) or not there.path.startswith("/"):
        return None
    return unquote(posixpath.relpath(there.path, posixpath.dirname(here.path)))


def missing_package(uri: str) -> str | None:
    """Return an error message if the imported package is not installed; ``None`` for any other import."""
    if not uri.startswith(_PACKAGE):
        return None
    package, _, inside = uri.removeprefix(_PACKAGE).partition("/")
    return (
        f"the package '{package}' is not installed here, so the names of '{inside}' are unknown: "
        "install it, or import the file by its path"
    )


def not_a_path(uri: str) -> str | None:
    """Return an error message if an import is not a path that is valid on every system; ``None`` if it is."""
    if not uri.startswith(_ADDRESS):
        return None
    written = unquote(uri.removeprefix(_ADDRESS))
    if not _ADDRESSES.match(written):
        return f"only Windows reads '{written}': write '{written.replace(BACKSLASH, '/')}', which all systems read"
    return f"'{written}' is an address: import a file of this machine by its path"


def importable_extensions(language: str) -> tuple[str, ...]:
    """Return the extensions, without the dot, of the files that a file of a language may import."""
    return (*IMPORTABLE.get(language, ()), *(GRAPH_FORMATS if language in _ENRICHED else ()))


def not_importable(importer: str, imported: str, uri: str) -> str | None:
    """Return an error message if the kind of a file must not import another file; ``None`` if it may.

    ``importer`` and ``imported`` are languages; ``imported`` is ``""`` if the file, ``uri``, is not a model file.
    """
    if imported in IMPORTABLE.get(importer, ()) or (importer in _ENRICHED and graph_format(uri)):
        return None
    *others, last = (f"'.{extension}'" for extension in importable_extensions(importer))
    listed = f"{', '.join(others)} and {last}" if others else last
    return f"only {listed} files can be imported here"


def reached(edges: Mapping[str, Iterable[str]], start: str) -> frozenset[str]:
    """Return the nodes reachable from a start, without the start."""
    return reached_from(edges, (start,)) - {start}


def reached_from(edges: Mapping[str, Iterable[str]], starts: Iterable[str]) -> frozenset[str]:
    """Return the starts and the nodes reachable from them."""
    found = set(starts)
    waiting = list(found)
    while waiting:
        fresh = [uri for uri in edges.get(waiting.pop(), ()) if uri not in found]
        found.update(fresh)
        waiting += fresh
    return frozenset(found)


def components(edges: Mapping[str, Sequence[str]]) -> dict[str, int]:
    """Number the strongly connected components of a graph by Tarjan's algorithm without recursion."""
    order: dict[str, int] = {}
    low: dict[str, int] = {}
    found: dict[str, int] = {}
    stack: list[str] = []
    for start in edges:
        work = [(start, iter(edges[start]))] if start not in order else []
        if work:
            order[start] = low[start] = len(order)
            stack.append(start)
        while work:
            node, successors = work[-1]
            fresh = None
            for other in successors:
                if other not in edges:
                    continue
                if other not in order:
                    fresh = other
                    break
                if other not in found:
                    low[node] = min(low[node], order[other])
            if fresh is not None:
                order[fresh] = low[fresh] = len(order)
                stack.append(fresh)
                work.append((fresh, iter(edges[fresh])))
                continue
            work.pop()
            if work:
                low[work[-1][0]] = min(low[work[-1][0]], low[node])
            if low[node] == order[node]:
                while node not in found:
                    found[stack.pop()] = order[node]
    return found


def _package_folder(package: str) -> Path | None:
    found = PathFinder.find_spec(package)
    places = None if found is None else found.submodule_search_locations
    return None if not places else Path(next(iter(places)))
