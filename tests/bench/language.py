"""How long reading a model takes, cold and after a keystroke, against textX on the whole file in the same run."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

from tests.bench.models import model

from kit import FOLDER, SCENE
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.split import split
from robbdd_tools.syntax.textx import parse_with_textx

KEYSTROKES = 60
FILES = 200


def milliseconds(work: Callable[[], object]) -> float:
    """Return the wall time of one call."""
    start = time.perf_counter()
    work()
    return 1000.0 * (time.perf_counter() - start)


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    parse_declaration("bdd", "Event (ns=t) warm-up")
    parse_declaration("scene", "scene (ns=t) warm-up { }")
    for lines in (100, 1000, 10_000):
        yield from _one_file(lines)
    yield from _many_files()


def _one_file(lines: int) -> Iterator[tuple[str, str]]:
    text = model(lines)
    count = text.count("\n")
    uri = f"{FOLDER}bench{lines}.bdd"
    project = Project()
    project.open(f"{FOLDER}lab.scene", 1, SCENE)
    parse_declaration.cache_clear()
    textx = milliseconds(lambda: [parse_with_textx("bdd", chunk.text) for chunk in split("bdd", text)])
    opened = milliseconds(lambda: _typed(project, uri, 1, text))
    yield f"cold open, {count} lines", f"{opened:.0f} ms, {1000 * opened / count:.0f} ms per 1000 lines"
    yield (
        f"rules beyond names, {count} lines",
        f"{milliseconds(lambda: fast_diagnostics(project.snapshot(), uri)):.0f} ms",
    )
    strokes = [
        milliseconds(lambda edited=edited, number=number: _typed(project, uri, number + 2, edited))
        for number, edited in enumerate(_typing(text))
    ]
    yield f"keystroke to diagnostics, {count} lines", f"{_percentiles(strokes)}; {_times(textx, strokes)}"
    offset = text.rindex("before <pick-start>") + len("before <")
    project.open(uri, 1000, text)
    asked = [milliseconds(lambda: complete(project.snapshot(), uri, offset)) for _ in range(KEYSTROKES)]
    yield f"completion, {count} lines", _percentiles(asked)


def _typed(project: Project, uri: str, version: int, text: str) -> None:
    """What a keystroke costs until its syntax and name diagnostics are there."""
    project.open(uri, version, text)
    analysis = project.snapshot().file(uri)
    assert analysis is not None
    assert analysis.document.version == version


def _typing(text: str) -> Iterator[str]:
    """Texts as they follow from typing a clause in the middle of a model, letter by letter; most are broken."""
    middle = text.index("Then:", len(text) // 2) + len("Then:")
    clause = "\n ( more: holds(<part> is located at <goal>, before <pick-start>) and"
    for length in range(1, KEYSTROKES + 1):
        yield text[:middle] + clause[:length] + text[middle:]


def _percentiles(figures: list[float]) -> str:
    hundredths = statistics.quantiles(figures, n=100, method="inclusive")
    return f"p50 {hundredths[49]:.1f}, p95 {hundredths[94]:.1f}, p99 {hundredths[98]:.1f} ms"


def _times(whole: float, strokes: list[float]) -> str:
    return f"textX on the whole text takes {whole / statistics.median(strokes):.0f} × as long"


def _many_files() -> Iterator[tuple[str, str]]:
    project = Project()
    project.open(f"{FOLDER}lab.scene", 1, SCENE)
    uris = [f"{FOLDER}file{number}.bdd" for number in range(FILES)]
    texts = [f'import "file{number + 1}.bdd"\n' + model(60) for number in range(FILES - 1)] + [model(60)]

    def load() -> None:
        for uri, text in zip(uris, texts, strict=True):
            project.open(uri, 1, text)
        for uri in uris:
            project.snapshot().file(uri)

    yield f"cold open, {FILES} files that import each other", f"{milliseconds(load):.0f} ms"
    strokes = [
        milliseconds(lambda edited=edited, number=number: _typed(project, uris[0], number + 2, edited))
        for number, edited in enumerate(_typing(texts[0]))
    ]
    yield f"keystroke to diagnostics, {FILES} files", _percentiles(strokes)
    yield "memory of a process with 10,000 lines open", f"{_memory():.0f} MB"


def _memory() -> float:
    script = f"""
import resource, sys
sys.path[:0] = {sys.path!r}
from kit import FOLDER, SCENE
from robbdd_tools.names.project import Project
from robbdd_tools.features.diagnostics import fast_diagnostics
from tests.bench.models import model
project = Project()
project.open(FOLDER + "lab.scene", 1, SCENE)
project.open(FOLDER + "m.bdd", 1, model(10_000))
fast_diagnostics(project.snapshot(), FOLDER + "m.bdd")
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""
    return float(subprocess.run([sys.executable, "-c", script], capture_output=True, check=True, text=True).stdout)
