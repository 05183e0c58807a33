"""How the time for large or hostile input grows: cycles of imports, lists in graphs."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from robbdd_tools.base.memory import collect_rarely
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.references import references
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.model import load_all

CYCLES = (1_000, 10_000)
ELEMENTS = 200_000
MODEL = """import "f{following}.bdd"
ns t{n} = 'https://example.org/{n}/'
Task (ns=t{n}) task-{n}
Event (ns=t{n}) event-{n}
"""
BROKEN = MODEL.replace(") task", " task")
EQUAL = MODEL.replace("t{n}", "t").replace("/{n}/", "/").replace("-{n}", "")


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement; all are processor time."""
    collect_rarely()
    for what, text, sizes in (
        ("different names", MODEL, CYCLES),
        ("a syntax error each", BROKEN, CYCLES),
        ("equal names", EQUAL, (500, 1_000)),
    ):
        small, large = (_with_cycle(text, count, lambda folder, _: _check([folder])) for count in sizes)
        yield f"check a cycle of {sizes[1]} files with {what}", _growth(large, small, sizes)
    small, large = (_with_cycle(MODEL, count, lambda folder, _: _check([folder / "f0.bdd"])) for count in CYCLES)
    yield f"check one file of a cycle of {CYCLES[1]}", _growth(large, small, CYCLES)
    small, large = (_with_cycle(MODEL, count, _edit) for count in CYCLES)
    yield f"keystroke, diagnostics and references in a cycle of {CYCLES[1]} files", _growth(large, small, CYCLES)
    yield from _list()


def _seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def _growth(large: float, small: float, sizes: tuple[int, int]) -> str:
    return f"{large:.2f} s; {large / small:.1f} × as long as {sizes[0]}, {sizes[1] / sizes[0]:.0f} × as many"


def _with_cycle(text: str, count: int, measure: Callable[[Path, int], float]) -> float:
    """Return a measurement in a folder of files that import each other in a circle."""
    with tempfile.TemporaryDirectory() as name:
        for number in range(count):
            written = text.format(n=number, following=(number + 1) % count)
            (Path(name) / f"f{number}.bdd").write_text(written, encoding="utf-8")
        return measure(Path(name), count)


def _check(paths: list[Path]) -> float:
    return _seconds(lambda: load_all(paths).diagnostics)


def _edit(folder: Path, count: int) -> float:
    project, path = Project(), folder / "f0.bdd"
    text, uri = path.read_text(encoding="utf-8"), path.as_uri()
    project.open(uri, 1, text)
    snapshot = project.snapshot()
    for number in range(count):
        snapshot.file((folder / f"f{number}.bdd").as_uri())

    def press() -> None:
        project.open(uri, 2, text + "// edited")
        edited = project.snapshot()
        fast_diagnostics(edited, uri)
        references(edited, uri, text.index("task-0"), with_declaration=True)

    return _seconds(press)


def _list() -> Iterator[tuple[str, str]]:
    """Compare a check of a list in a graph file with rdflib's parser alone."""
    from rdflib import Graph

    text = f"@prefix e: <https://example.org/> .\ne:a e:items ({' '.join(f'e:i{n}' for n in range(ELEMENTS))}) .\n"
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "list.ttl"
        path.write_text(text, encoding="utf-8")
        checked = _check([path])
        built = load_all([path]).files[0].graph
        validated = _seconds(lambda: validate(built))
    parsed = _seconds(lambda: Graph().parse(data=text, format="turtle"))
    yield (
        f"check a Turtle list of {ELEMENTS:,} elements",
        f"{checked:.1f} s; {checked / parsed:.1f} × as long as rdflib's parser alone; "
        f"{validated:.1f} s of it for SHACL, nearly all to copy the graph into the store that pyshacl needs",
    )
