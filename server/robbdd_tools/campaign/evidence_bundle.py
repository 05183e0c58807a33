"""Write the evidence of a run as one file: what was required, executed and judged, and by which versions.

A bundle is a ZIP archive:

- ``bundle.json``: the SHA-256 of every other file, the versions, and the name of the model file.
- ``sources/``: the texts of the models and of their imports, and the files that the run used.
- ``run/``: the record, the manifest, the results and the traces of the run.
- ``graph.ttl``: requirements, scenarios, clauses, executions, verdicts (EARL) and traces (PROV) as one graph.

Equal runs of equal models make equal bundles, byte for byte.
"""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from robbdd_tools import __version__
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replacing_bytes
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.results import finished_in
from robbdd_tools.run.store import RECORD, RESULTS
from robbdd_tools.workbench.unchanged import model_now, refusal

if TYPE_CHECKING:
    from robbdd_tools.workbench.model import Model
    from robbdd_tools.workbench.stored import PastRun

FORMAT = 1
CONTENTS, GRAPH = "bundle.json", "graph.ttl"
SOURCES, RUN = "sources", "run"
_DATE = (1980, 1, 1, 0, 0, 0)
"""All entries have this date, the earliest one that a ZIP archive can have."""


class NoEvidence(RobbddError):
    """A run cannot be written as a bundle; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class Bundle:
    """A bundle that was written: the SHA-256 of its list of contents, and the number of its traces."""

    digest: str
    traces: int


def write_bundle(run: PastRun, output: Path, *, traces: bool = True) -> Bundle:
    """Write the bundle of a stored run. Raises ``NoEvidence``, ``NoSuchRun``, ``ModelErrors`` and ``OSError``.

    The model must be unchanged since the run, so that the bundle is evidence for the text of its requirements.
    """
    place, record = run.place, run.record
    model = model_now(place)
    reason = refusal(place, model)
    if reason or isinstance(model, str):
        raise NoEvidence(f"{reason}: a bundle contains the model that was executed; run it again")
    if len(model.runnable) > 1:
        names = ", ".join(file.name for file in model.runnable)
        raise NoEvidence(f"a bundle is of one model, and the run has executed {names}: run them one by one")
    document = place.results()
    finished = finished_in(document)
    kept = {index: path for index in finished if (path := trace_file(run.folder, index)).is_file()} if traces else {}
    files: dict[str, bytes] = _sources(model, run)
    source = _entry(files, model)
    files[f"{RUN}/{RECORD}"] = _json({**asdict(record), "origin": "", "models": []})
    files[f"{RUN}/{MANIFEST}"] = load_bytes(run.folder / MANIFEST, RESULT_SIZE)
    files[f"{RUN}/{RESULTS}"] = _json(document)
    for index, path in sorted(kept.items()):
        files[f"{RUN}/{trace_file(Path(), index).as_posix()}"] = load_bytes(path, RESULT_SIZE)
    digests = {index: _sha(files[f"{RUN}/{trace_file(Path(), index).as_posix()}"]) for index in kept}
    files[GRAPH] = graph_of(model, document, digests).encode()
    contents = _json(
        {
            "format": FORMAT,
            "robbdd": __version__,
            "simulator": record.simulator,
            "model": source,
            "graph_digest": record.digest,
            "files": {name: _sha(data) for name, data in sorted(files.items())},
        }
    )
    with replacing_bytes(output) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in ((CONTENTS, contents), *sorted(files.items())):
            entry = zipfile.ZipInfo(name, _DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data)
    return Bundle(_sha(contents), len(kept))


def graph_of(model: Model, document: Mapping[str, Any], digests: Mapping[int, str]) -> str:
    """Return the graph of a single-file model with the results and traces of a run, as Turtle.

    The results are added to the graph of ``model`` itself. Raises ``BadResults`` and ``ModelErrors``.
    """
    from robbdd_tools.graph.rdf.serialize import serialize
    from robbdd_tools.graph.write.run_results import add_results, add_traces

    (file,) = model.runnable
    graph = file.graph.graph
    add_results(graph, document)
    add_traces(graph, document, digests)
    return serialize(graph, "ttl")


def _sources(model: Model, run: PastRun) -> dict[str, bytes]:
    """Return the files of the model and those that the run used, named by their paths below a common folder."""
    texts: dict[Path, bytes] = {}
    for file in model.runnable:
        for analysis in file.snapshot.closure(file.uri):
            path = uri_to_path(analysis.document.uri)
            if path is not None:
                texts[path.resolve()] = load_bytes(path)
    for name in run.record.files:
        path = (run.folder / name).resolve()
        texts[path] = load_bytes(path, RESULT_SIZE)
    root = Path(os.path.commonpath([path.parent for path in texts]))
    return {f"{SOURCES}/{path.relative_to(root).as_posix()}": data for path, data in texts.items()}


def _entry(files: Iterable[str], model: Model) -> str:
    """Return the bundle's name of the file that was run: the longest ending of its path that is in the bundle."""
    path = uri_to_path(model.runnable[0].uri)
    assert path is not None
    ending = path.resolve().as_posix()
    found = [name for name in files if ending.endswith(f"/{PurePosixPath(name).relative_to(SOURCES).as_posix()}")]
    return max(found, key=len)


def _json(document: Any) -> bytes:
    return (printable_json(json.loads(json.dumps(document)), indent=1) + "\n").encode()


def _sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
