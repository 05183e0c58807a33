"""How long after an edit the shapes' findings are there, against validating the whole graph; engines for queries."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from tests.bench.models import long_story, model

from kit import FOLDER, SCENE
from robbdd_tools.base.memory import collect_rarely
from robbdd_tools.graph.ask.query import ready_query, run_query
from robbdd_tools.graph.shapes.incremental import Validation
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project

if TYPE_CHECKING:
    from rdflib import Graph

EDITS, FEW_EDITS = 40, 5
TRIPLES = 100_000
QUERIES = ("idle-events", "variants", "clause-times")
SLOW_QUERIES = ("predicate-coverage", "clauses-by-workspace")
"""Those for which rdflib's engine needs more than minutes."""


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    collect_rarely()  # As the validation process does.
    for lines in (100, 1000, 10_000):
        text = model(lines)
        yield _edits(text, f"{text.count(chr(10))} lines", "0.5 seconds", EDITS)
    yield _edits(long_story(10_000), "one story of 10000 lines", "{ <arms.panda> }", FEW_EDITS)
    yield from _engines()


def _edits(text: str, name: str, old: str, count: int) -> tuple[str, str]:
    """Measure edits of a text: growing space after the first word of the first ``old`` in its second half."""
    uri = f"{FOLDER}bench.bdd"
    project, validation = Project(), Validation()
    project.open(f"{FOLDER}lab.scene", 1, SCENE)
    project.open(uri, 1, text)
    validation.run(project.snapshot(), uri)
    place = text.index(old, len(text) // 2) + old.index(" ")
    edits: list[float] = []
    for number in range(count):
        edited = f"{text[:place]}{' ' * (number + 1)}{text[place:]}"

        def validated(version: int = number + 2, edited: str = edited) -> None:
            project.open(uri, version, edited)
            validation.run(project.snapshot(), uri)
            assert validation.looked_at

        edits.append(_milliseconds(validated))
    whole = _milliseconds(lambda: validate(build_graph(project.snapshot(), uri)))
    hundredths = statistics.quantiles(edits, n=100, method="inclusive")
    figures = f"p50 {hundredths[49]:.0f}, p95 {hundredths[94]:.0f} ms; the whole graph takes {whole:.0f} ms"
    return f"edit to the shapes' findings, {name}", figures


def _engines() -> Iterator[tuple[str, str]]:
    """Compare rdflib's engine with that of Oxigraph, if installed, on one graph."""
    graph = _large_graph()
    native = _oxigraph(graph)
    for name in QUERIES:
        query = ready_query(name) or ""
        ours = _milliseconds(lambda query=query: list(graph.query(query)))
        theirs = None if native is None else _milliseconds(lambda query=query: native(query))
        ratio = "" if theirs is None else f"; Oxigraph {theirs:.1f} ms, {ours / theirs:.0f} × as fast"
        yield f"query {name}, {len(graph)} triples", f"{ours:.0f} ms{ratio}"
    for name in SLOW_QUERIES if native is not None else ():
        query = ready_query(name) or ""
        whole = _milliseconds(lambda query=query: run_query(graph, query))
        yield f"query {name}, {len(graph)} triples", f"Oxigraph {whole:.0f} ms, with copying the graph to it"


def _large_graph() -> Graph:
    uri, project = f"{FOLDER}bench.bdd", Project()
    project.open(f"{FOLDER}lab.scene", 1, SCENE)
    project.open(uri, 1, model(TRIPLES * 10_000 // 44_000))
    return build_graph(project.snapshot(), uri).graph


def _oxigraph(graph: Graph) -> Callable[[str], object] | None:
    """Return what answers queries on a copy of a graph, ``None`` without pyoxigraph."""
    from importlib import import_module
    from importlib.util import find_spec
    from typing import Any

    if find_spec("pyoxigraph") is None:
        return None
    oxigraph: Any = import_module("pyoxigraph")
    store = oxigraph.Store()
    store.load(graph.serialize(format="nt").encode(), oxigraph.RdfFormat.N_TRIPLES)
    return lambda query: list(store.query(query))


def _milliseconds(work: Callable[[], object]) -> float:
    """Return the processor time of one call, so that what else the machine does does not count."""
    start = time.process_time()
    work()
    return 1000.0 * (time.process_time() - start)
