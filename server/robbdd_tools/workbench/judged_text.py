"""Digests of the text that a run judged. They are stored in the run folder to detect later changes of the text."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import load_text, path_to_uri, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.features.run_verdicts import Digests, digests_of
from robbdd_tools.run.store import relative_model_path

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

FILE = "text.json"


@dataclass(frozen=True, slots=True)
class JudgedText:
    """The text of one model in a run: its ``name`` in the manifest, its URI and its digests."""

    name: str
    uri: str
    digests: Digests


@dataclass(frozen=True, slots=True)
class JudgedTexts:
    """The texts that a run judged.

    ``some_repetitions`` is true if the run executed only some repetitions of its scenarios.
    """

    texts: tuple[JudgedText, ...]
    some_repetitions: bool = False

    def named(self) -> Mapping[str, JudgedText]:
        """Map the name of each model in the manifest to its text."""
        return {text.name: text for text in self.texts}


@dataclass(frozen=True, slots=True)
class _Stored:
    """The JSON form of a text. ``place`` is a path relative to the run folder, or the URI of a text without a file."""

    name: str
    place: str
    clauses: Mapping[str, str]
    variants: Mapping[str, str]
    rows: Mapping[str, Mapping[str, str]]
    executions: Mapping[str, str]


def judged_texts(files: Iterable[tuple[str, Snapshot, str]], *, some_repetitions: bool = False) -> JudgedTexts:
    """Return the texts of models. Each model is given by its name, a snapshot and its URI."""
    texts = (JudgedText(name, uri, digests_of(snapshot, uri)) for name, snapshot, uri in files)
    return JudgedTexts(tuple(texts), some_repetitions)


def write_texts(texts: JudgedTexts, folder: Path) -> None:
    """Write the texts of a run into its folder; raises ``OSError``."""
    stored = [asdict(_stored(text, folder)) for text in texts.texts]
    document = {"texts": stored, "some_repetitions": texts.some_repetitions}
    replace_file(folder / FILE, printable_json(document) + "\n")


def read_texts(folder: Path) -> JudgedTexts:
    """Return the texts written by ``write_texts``.

    Raises ``OSError``, ``ValueError``, ``KeyError``, ``TypeError`` and ``AttributeError`` if they are missing or
    malformed.
    """
    document = json.loads(load_text(folder / FILE, RESULT_SIZE))
    texts = (_text(from_plain(_Stored, one), folder) for one in document["texts"])
    return JudgedTexts(tuple(texts), document["some_repetitions"] is True)


def _stored(text: JudgedText, folder: Path) -> _Stored:
    path = uri_to_path(text.uri)
    place = text.uri if path is None else relative_model_path(path, folder)
    rows: dict[str, dict[str, str]] = {}
    for (variant, number), digest in text.digests.rows.items():
        rows.setdefault(variant, {})[str(number)] = digest
    return _Stored(text.name, place, text.digests.clauses, text.digests.variants, rows, text.digests.executions)


def _text(stored: _Stored, folder: Path) -> JudgedText:
    rows = {(iri, int(number)): digest for iri, own in stored.rows.items() for number, digest in own.items()}
    digests = Digests(stored.clauses, stored.variants, rows, stored.executions)
    is_uri = ":" in stored.place.partition("/")[0] and uri_to_path(stored.place) is None
    return JudgedText(stored.name, stored.place if is_uri else path_to_uri(folder / stored.place), digests)
