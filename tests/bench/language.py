"""How long reading a model takes, cold and after a keystroke, against textX on the whole file in the same run."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator

from tests.bench.models import model

from kit import FOLDER, SCENE
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.textx import parse_with_textx
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.split import split

KEYSTROKES = 40


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
        text = model(lines)
        count = text.count("\n")
        uri = f"{FOLDER}bench{lines}.bdd"
        project = Project()
        project.open(f"{FOLDER}lab.scene", 1, SCENE)
        parse_declaration.cache_clear()

        def cold(project: Project = project, uri: str = uri, text: str = text) -> None:
            project.open(uri, 1, text)
            assert fast_diagnostics(project.snapshot(), uri) == []

        whole = milliseconds(lambda text=text: [parse_with_textx("bdd", chunk.text) for chunk in split("bdd", text)])
        opened = milliseconds(cold)
        yield f"parse + link, {count} lines", f"{opened:.0f} ms, {1000 * opened / count:.0f} ms per 1000 lines"
        strokes = [_keystroke(project, uri, text, number) for number in range(KEYSTROKES)]
        typed = statistics.median(strokes)
        worst = statistics.quantiles(strokes, n=20)[-1]
        yield (
            f"keystroke to diagnostics, {count} lines",
            f"median {typed:.1f} ms, p95 {worst:.1f} ms; textX on the whole text takes {whole / typed:.0f} × as long",
        )
        offset = text.index("before <pick-start>") + len("before <")
        asked = milliseconds(lambda project=project, uri=uri, offset=offset: complete(project.snapshot(), uri, offset))
        yield f"completion, {count} lines", f"{asked:.1f} ms"


def _keystroke(project: Project, uri: str, text: str, number: int) -> float:
    edited = text.replace('"operator"', f'"operator {number}"', 1)

    def work() -> None:
        project.open(uri, number + 2, edited)
        fast_diagnostics(project.snapshot(), uri)

    return milliseconds(work)
