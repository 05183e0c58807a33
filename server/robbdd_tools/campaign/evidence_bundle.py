"""Write the evidence of a run as one file: what was required, executed and judged, and by which versions.

A bundle is a ZIP archive:

- ``bundle.json``: the SHA-256 of every other file, the versions, and the name of the model file.
- ``sources/``: the texts of the models and of their imports, and the files that the run used.
- ``run/``: the record, the manifest, the results and the traces of the run.
- ``graph.ttl``: requirements, scenarios, clauses, executions, verdicts (EARL) and traces (PROV) as one graph.

Equal runs of equal models make equal bundles, byte for byte.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools import __version__
from robbdd_tools.base.files import load_bytes, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.campaign.evidence_parts import (
    SOURCES,
    Bundle,
    NoEvidence,
    entry_of,
    json_bytes,
    sha256,
    source_names,
    write_archive,
)
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.results import finished_in
from robbdd_tools.run.store import RECORD, RESULTS
from robbdd_tools.workbench.unchanged import model_now, refusal

if TYPE_CHECKING:
    from robbdd_tools.workbench.model import Model
    from robbdd_tools.workbench.stored import PastRun

GRAPH = "graph.ttl"
RUN = "run"


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
    files[f"{RUN}/{RECORD}"] = json_bytes({**asdict(record), "origin": "", "models": []})
    files[f"{RUN}/{MANIFEST}"] = load_bytes(run.folder / MANIFEST, RESULT_SIZE)
    files[f"{RUN}/{RESULTS}"] = json_bytes(document)
    for index, path in sorted(kept.items()):
        files[f"{RUN}/{trace_file(Path(), index).as_posix()}"] = load_bytes(path, RESULT_SIZE)
    digests = {index: sha256(files[f"{RUN}/{trace_file(Path(), index).as_posix()}"]) for index in kept}
    files[GRAPH] = graph_of(model, document, digests).encode()
    contents = {
        "robbdd": __version__,
        "simulator": record.simulator,
        "model": source,
        "graph_digest": record.digest,
    }
    return Bundle(write_archive(output, contents, files), len(kept))


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
    names = source_names(texts)
    return {names[path]: data for path, data in texts.items()}


def _entry(files: Iterable[str], model: Model) -> str:
    """Return the bundle's name of the file that was run: the longest ending of its path that is in the bundle."""
    path = uri_to_path(model.runnable[0].uri)
    assert path is not None
    return entry_of(path, (name for name in files if name.startswith(SOURCES)))
