"""Load JSON-LD contexts by name.

A context is a file in the folder of the model, the context of RobBDD, or a cached context that the user allowed to
fetch. The addresses of the published metamodels are known. For them, the context of RobBDD is used, which includes
terms of older versions.
"""

from __future__ import annotations

import hashlib
import json
import urllib.request
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path, PurePosixPath
from time import monotonic
from typing import Any, cast
from urllib.error import URLError
from urllib.parse import urlsplit

from robbdd_tools.base.cache_folder import cache_folder as cached_data
from robbdd_tools.base.data import data_file
from robbdd_tools.base.files import Unreadable, load_text, read_text, uri_to_path
from robbdd_tools.base.limits import MIB, MODEL_SIZE
from robbdd_tools.base.user_settings import user_file
from robbdd_tools.base.writing import replace_file
from robbdd_tools.catalog.term_prefixes import METAMODELS

Json = dict[str, Any]
CONTEXT_FILE = "context.jsonld"
CONTEXT_IRI = f"https://robbdd.org/metamodels/{CONTEXT_FILE}"
"""Name of our context. Like ``context.jsonld`` next to a model, it is available without network."""
_PUBLISHED = frozenset(
    {
        *("agent", "bdd", "behaviour", "behaviour-tree", "environment", "event", "execution-context"),
        *("observation", "python", "task", "time"),
    }
)
"""Names of the published context files whose terms our context includes."""
_OLDER = {
    "holds": "bdd:holds",
    "holds-at": "bdd:holds-at",
    "predicate": "bdd:predicate",
    "time-constraint": "bdd:time-constraint",
    "of-clause": "bdd:of-clause",
    "of-variable": "bdd:of-variable",
    "ref-event": "time:ref-event",
    "of-constraint": "time:of-constraint",
}
"""Terms of older published metamodels. They are included so that no triple is lost."""
TIMEOUT = 20.0
"""Maximum time (s) for a server's answer."""
_WANTED = "application/ld+json, application/json;q=0.9"


class UnknownContext(Exception):
    """A JSON-LD document names a context that is not available. The message says how to fix it."""


@dataclass(frozen=True, slots=True)
class ContextLoader:
    """Loads contexts for pyld. Only the user's ``hosts`` are contacted, once for each context.

    ``folder`` is the folder of the model. A file in it replaces a web address that ends with the path of the file.
    """

    hosts: frozenset[str] = frozenset()
    folder: Path | None = None

    def beside(self, document: str) -> ContextLoader:
        """Return a loader that also searches the folder of a document, which is given by its URI."""
        path = uri_to_path(document) if document else None
        return self if path is None else replace(self, folder=path.parent)

    def __call__(self, url: str, _options: Mapping[str, Any]) -> Json:
        """Return the context at a URL in the form that pyld requires of a loader. Raises ``UnknownContext``."""
        return {
            "contentType": "application/ld+json",
            "contextUrl": None,
            "documentUrl": url,
            "document": self.document(url),
        }

    def document(self, url: str) -> Any:
        """Return the JSON document at a URL; raises ``UnknownContext``."""
        path = uri_to_path(url)
        if url in (CONTEXT_IRI, CONTEXT_FILE) or (path and path.name == CONTEXT_FILE and not path.is_file()):
            return {"@context": bundled_context()}
        if path is not None:
            return _local(url, path)
        if urlsplit(url).scheme not in ("http", "https"):
            raise UnknownContext(f"the context '{url}' is neither a file nor a web address")
        own = None if self.folder is None else file_for(url, self.folder)
        stated = None if own is None else _local(url, own)
        # A model may have the name of a published context, such as environment.json. It does not replace the context.
        if stated is not None and not (is_published(url) and _has_nodes(stated)):
            return stated
        if is_published(url):
            return {"@context": published_context()}
        text = _cached(url)
        return _json(url, self._fetch(url) if text is None else text)

    def _fetch(self, url: str) -> str:
        self._check(url)
        opener = urllib.request.build_opener(_Redirects(self._check))
        try:
            with opener.open(urllib.request.Request(url, headers={"Accept": _WANTED}), timeout=TIMEOUT) as answer:
                data = _read(answer, url)
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            raise UnknownContext(f"the context '{url}' is not UTF-8 text") from None
        except (URLError, OSError) as error:
            reason = getattr(error, "reason", None) or error
            raise UnknownContext(f"the context '{url}' cannot be fetched: {reason}") from error
        if len(data) > MODEL_SIZE.value():
            raise UnknownContext(f"the context '{url}' is larger than {MODEL_SIZE.value() / MIB:.3g} MiB")
        _json(url, text)
        _keep(url, text)
        return text

    def _check(self, url: str) -> None:
        host = urlsplit(url).hostname or ""
        if urlsplit(url).scheme not in ("http", "https"):
            raise UnknownContext(f"the context '{url}' is not a web address: a server redirected to it")
        if host not in self.hosts:
            raise UnknownContext(
                f"the context '{url}' is not fetched: allow it once with '--allow-host {host}', "
                f"or always with 'context-hosts = [\"{host}\"]' in {user_file()}, "
                "or write the context into the document itself"
            )


class _Redirects(urllib.request.HTTPRedirectHandler):
    """Follows redirections to allowed hosts only."""

    def __init__(self, check: Callable[[str], None]) -> None:
        self._check_host = check

    def redirect_request(self, req: Any, fp: Any, code: Any, msg: Any, headers: Any, newurl: str) -> Any:
        self._check_host(newurl)
        return super().redirect_request(req, fp, code, msg, headers, newurl)


def _read(answer: Any, url: str) -> bytes:
    """Read the answer of a server, up to one byte more than the limit.

    Raises ``UnknownContext`` if the server is too slow.
    """
    most, data, deadline = MODEL_SIZE.value() + 1, bytearray(), monotonic() + TIMEOUT
    while len(data) < most and (part := answer.read1(min(65536, most - len(data)))):
        data += part
        if monotonic() > deadline:
            raise UnknownContext(f"the context '{url}' cannot be fetched: the server takes longer than {TIMEOUT:g} s")
    return bytes(data)


@cache
def bundled_context() -> Json:
    """Return our JSON-LD context."""
    text = load_text(data_file("metamodels", CONTEXT_FILE))
    return cast(Json, json.loads(text)["@context"])


def is_published(url: str) -> bool:
    """Return whether an address belongs to a context of the published metamodels, in any layout."""
    if not url.startswith(METAMODELS):
        return False
    path = PurePosixPath(urlsplit(url).path)
    return path.suffix in (".json", ".jsonld") and path.stem in _PUBLISHED


@cache
def published_context() -> Json:
    """Return the context that replaces all published contexts. As in these, strings name the values."""
    named = {"@type": "@id", "@container": "@list"}
    values = {"elements": {"@id": "bdd:elements", "@type": "@id"}}
    values |= {term: {"@id": f"bdd:{term}", **named} for term in ("of-sets", "rows")}
    older = {term: {"@id": name, "@type": "@id"} for term, name in _OLDER.items()}
    return {**bundled_context(), **older, **values, "repetition": "bdd:repetition-allowed"}


def file_for(url: str, folder: Path) -> Path | None:
    """Return the file in a folder whose path matches the longest end of a web address."""
    parts = PurePosixPath(urlsplit(url).path).parts[1:]
    candidates = (folder.joinpath(*parts[start:]) for start in range(len(parts)) if ".." not in parts)
    return next((path for path in candidates if path.is_file()), None)


def cache_folder() -> Path:
    """Return the folder of fetched contexts."""
    return cached_data() / "contexts"


def _local(url: str, path: Path) -> Any:
    text = read_text(path)
    if isinstance(text, Unreadable):
        raise UnknownContext(f"the context cannot be read: {text.reason}")
    return _json(url, text)


def _has_nodes(document: Any) -> bool:
    keys = cast(Json, document).keys() if isinstance(document, dict) else ("@graph",)
    return not {"@graph", "@id", "@type"}.isdisjoint(keys)


def _json(url: str, text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UnknownContext(f"the context '{url}' is not JSON: {error}") from error


def _place(url: str) -> Path:
    return cache_folder() / f"{_hash(url)}.json"


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _cached(url: str) -> str | None:
    """Return the cached copy if its text is still the fetched one."""
    try:
        entry = cast(Json, json.loads(load_text(_place(url))))
        text = str(entry["text"])
        return text if entry["url"] == url and entry["sha256"] == _hash(text) else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _keep(url: str, text: str) -> None:
    place = _place(url)
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        replace_file(place, json.dumps({"url": url, "sha256": _hash(text), "text": text}))
    except OSError as error:
        raise UnknownContext(f"the context '{url}' cannot be kept in {place.parent}: {error.strerror}") from error
