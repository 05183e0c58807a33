"""How long reading a model takes, cold and after a keystroke, against textX on the whole file in the same run.

All of it is work of one thread, so that its processor time is measured: what else the machine does does not count.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from pathlib import Path

from tests.bench.models import long_story, model

from kit import FOLDER, SCENE
from robbdd_tools.base.checkpoint import watched
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.memory import collect_rarely
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.hover import hover
from robbdd_tools.features.references import references
from robbdd_tools.features.rename import rename
from robbdd_tools.features.rename_files import affected_files, import_edits
from robbdd_tools.features.semantic_tokens import coloured
from robbdd_tools.features.workspace_files import model_files
from robbdd_tools.features.workspace_symbols import workspace_symbols
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.syntax.parse import forget_declarations, parse_declaration
from robbdd_tools.syntax.split import split
from robbdd_tools.syntax.textx import parse_with_textx

KEYSTROKES = 60
FILES = 200
PROJECT_FILES = 1000


def milliseconds(work: Callable[[], object]) -> float:
    """Return the processor time of one call."""
    start = time.process_time()
    work()
    return 1000.0 * (time.process_time() - start)


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    collect_rarely()  # As the language server does.
    parse_declaration("bdd", "Event (ns=t) warm-up")
    parse_declaration("scene", "scene (ns=t) warm-up { }")
    for lines in (100, 1000, 10_000):
        text = model(lines)
        yield from _one_file(text, f"{text.count(chr(10))} lines", typing(text))
    for lines in (1000, 10_000):
        text = long_story(lines)
        yield from _one_file(text, f"one story of {lines} lines", typing_a_variation(text))
    yield from _many_files()
    yield from _project()


def _one_file(text: str, name: str, typing: Iterator[str]) -> Iterator[tuple[str, str]]:
    count = text.count("\n")
    uri = f"{FOLDER}bench.bdd"
    project = Project()
    project.open(f"{FOLDER}lab.scene", 1, SCENE)
    forget_declarations()
    left = _uninterrupted(lambda: Project().open(uri, 1, text))
    yield f"a text that another one has replaced is left within, {name}", f"{left:.0f} ms"
    forget_declarations()
    textx = milliseconds(lambda: [parse_with_textx("bdd", chunk.text) for chunk in split("bdd", text)])
    opened = milliseconds(lambda: _typed(project, uri, 1, text))
    yield f"cold open, {name}", f"{opened:.0f} ms, {1000 * opened / count:.0f} ms per 1000 lines"
    yield (
        f"rules beyond names, {name}",
        f"{milliseconds(lambda: fast_diagnostics(project.snapshot(), uri)):.0f} ms",
    )
    strokes: list[float] = []
    rules: list[float] = []
    for number, edited in enumerate(typing):
        strokes.append(milliseconds(lambda edited=edited, number=number: _typed(project, uri, number + 2, edited)))
        rules.append(milliseconds(lambda: fast_diagnostics(project.snapshot(), uri)))
    yield f"keystroke to diagnostics, {name}", f"{_percentiles(strokes)}; {_times(textx, strokes)}"
    yield f"rules beyond names after a keystroke, {name}", _percentiles(rules)
    offset = text.rindex("before <pick-start>") + len("before <")
    if "one story" in name:
        offset = text.rindex("template: <") + len("template: <")
    project.open(uri, 1000, text)
    asked = [milliseconds(lambda: complete(project.snapshot(), uri, offset)) for _ in range(KEYSTROKES)]
    yield f"completion, {name}", _percentiles(asked)
    project.open(uri, 1001, text + "// edited")
    requests: list[Callable[[Snapshot], object]] = [
        lambda snapshot: coloured(snapshot, uri),
        lambda snapshot: complete(snapshot, uri, offset),
        lambda snapshot: hover(snapshot, uri, offset + 1),
        lambda snapshot: references(snapshot, uri, offset + 1, with_declaration=True),
        lambda snapshot: fast_diagnostics(snapshot, uri),
    ]
    longest = max(_uninterrupted(partial(request, project.snapshot())) for request in requests)
    yield f"a cancelled request stops within, {name}", f"{longest:.0f} ms"


def _uninterrupted(work: Callable[[], object]) -> float:
    """Return the longest processor time of some work between two checkpoints."""
    places = [time.process_time()]
    with watched(lambda: places.append(time.process_time())):
        work()
    places.append(time.process_time())
    return 1000.0 * max(later - earlier for earlier, later in pairwise(places))


def _typed(project: Project, uri: str, version: int, text: str) -> None:
    """What a keystroke costs until its syntax and name diagnostics are there."""
    project.open(uri, version, text)
    analysis = project.snapshot().file(uri)
    assert analysis is not None
    assert analysis.document.version == version


def typing(text: str) -> Iterator[str]:
    """Texts as they follow from typing a clause in the middle of a model, letter by letter; most are broken."""
    middle = text.index("Then:", len(text) // 2) + len("Then:")
    clause = "\n ( more: holds(<part> is located at <goal>, before <pick-start>) and"
    for length in range(1, KEYSTROKES + 1):
        yield text[:middle] + clause[:length] + text[middle:]


def typing_a_variation(text: str) -> Iterator[str]:
    """Texts as they follow from typing a line of a variation in the middle of a long story."""
    middle = text.index("variation:", len(text) // 2) + len("variation:")
    line = "\n var <fetch1.goal1>: { <places.bench_ws>, <places.tray_ws> }"
    for length in range(1, KEYSTROKES + 1):
        yield text[:middle] + line[:length] + text[middle:]


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
        for number, edited in enumerate(typing(texts[0]))
    ]
    yield f"keystroke to diagnostics, {FILES} files", _percentiles(strokes)
    yield "memory of a process with 10,000 lines open", f"{_memory('model(10_000),'):.0f} MB"
    named = "{}.replace('goal', 'goal' + n * 'x')"
    typed = f"*typing({named.format('model(10_000)')}), *typing_a_variation({named.format('long_story(1000)')})"
    edits = f"(text for n in range(10) for text in ({typed}))"
    yield "memory of the same and a story of 1000 lines after 1200 keystrokes", f"{_memory(edits):.0f} MB"


def _project() -> Iterator[tuple[str, str]]:
    """Measure a folder of many unopened files that share a scene and import one another in groups of ten."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "lab.scene").write_text(SCENE, encoding="utf-8")
        uris = [path_to_uri(folder / f"file{number}.bdd") for number in range(PROJECT_FILES)]
        for number in range(PROJECT_FILES):
            following = f'import "file{number + 1}.bdd"\n' if number % 10 < 9 else ""
            text = following + model(60).replace("goal", f"goal-{number}-")
            (folder / f"file{number}.bdd").write_text(text, encoding="utf-8")
        project, what = Project(), f"{PROJECT_FILES} files"
        closed, root = project.snapshot(), [path_to_uri(folder)]
        first = milliseconds(lambda: workspace_symbols(closed, root, "goal-777-"))
        opened = milliseconds(lambda: [project.load(uri) for uri in uris])
        opened += milliseconds(lambda: list(map(project.snapshot().file, uris)))
        beside = f"{first:.0f} ms; opening them takes {opened / first:.1f} × as long"
        yield f"first search of workspace symbols, project of {what}, all closed", beside
        yield f"cold open, project of {what}", f"{opened:.0f} ms"
        text = (folder / "file0.bdd").read_text(encoding="utf-8")
        strokes = [
            milliseconds(lambda edited=edited, number=number: _published(project, uris[0], number + 1, edited))
            for number, edited in enumerate(typing(text))
        ]
        yield f"keystroke to diagnostics, project of {what}", _percentiles(strokes)
        snapshot, scene = project.snapshot(), path_to_uri(folder / "lab.scene")
        found = milliseconds(lambda: workspace_symbols(snapshot, (), "goal-777-"))
        yield f"workspace symbols, project of {what}", f"{found:.0f} ms"
        place = SCENE.index("tray_ws")
        renamed = milliseconds(lambda: rename(snapshot, scene, place, "crate_ws"))
        yield f"rename in all files, project of {what}", f"{renamed:.0f} ms"
        moves = {scene: path_to_uri(folder / "cell.scene")}
        moved = milliseconds(lambda: import_edits(affected_files(model_files([path_to_uri(folder)]), moves), moves))
        yield f"imports of a moved file, project of {what}, all closed", f"{moved:.0f} ms"


def _published(project: Project, uri: str, version: int, text: str) -> None:
    """What a keystroke costs until all fast diagnostics of a file, and which files they concern, are known."""
    _typed(project, uri, version, text)
    snapshot = project.snapshot()
    fast_diagnostics(snapshot, uri)
    snapshot.importers(uri)


def _memory(edits: str) -> float:
    """Return the most memory, in MiB, that a process takes which analyses some texts in turn."""
    script = f"""
import sys
sys.path[:0] = {sys.path!r}
from kit import FOLDER, SCENE
from robbdd_tools.base.memory import collect_rarely
from robbdd_tools.names.project import Project
from robbdd_tools.features.diagnostics import fast_diagnostics
from tests.bench.language import typing, typing_a_variation
from tests.bench.models import long_story, model
collect_rarely()
project = Project()
uri = FOLDER + "m.bdd"
project.open(FOLDER + "lab.scene", 1, SCENE)
for text in ({edits}):
    project.open(uri, 1, text)
    fast_diagnostics(project.snapshot(), uri)
print(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")).split()[1])
"""
    return (
        float(subprocess.run([sys.executable, "-c", script], capture_output=True, check=True, text=True).stdout) / 1024
    )
