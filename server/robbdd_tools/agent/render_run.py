"""Render pictures of a run folder without a display.

``python -m robbdd_tools.agent.render_run RUN_FOLDER INDEX FILE.png`` renders the initial scene of scenario number INDEX
(from 0); ``… RUN_FOLDER moments FOLDER`` the moment of every violated clause; ``… RUN_FOLDER videos FOLDER`` every
scenario from start to end, by a bit-identical second execution; ``… RUN_FOLDER thumbnails FOLDER INDEX:LINE …`` small
pictures of some violations (scenario, feature line).

Exit codes: 0 done; 2 the scene cannot be set up or a file cannot be read or written; 3 no graphics back end works (the
environment variable ``MUJOCO_GL`` selects ``egl``, ``osmesa`` or ``glfw``). Messages go to standard error, the names of
the pictures to standard output.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.file_names import safe_stem
from robbdd_tools.base.graphics import NO_GRAPHICS
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.run_folder import thumbnail_file
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.agent.violation_states import ViolationState
    from robbdd_tools.protocol.specs import Manifest, ScenarioSpec

FAILED = 2
MOMENTS, VIDEOS, THUMBNAILS = "moments", "videos", "thumbnails"
USAGE = (
    "usage: python -m robbdd_tools.agent.render_run RUN_FOLDER "
    "(INDEX FILE.png | moments FOLDER | videos FOLDER | thumbnails FOLDER INDEX:LINE …)"
)
SMALL = (300, 188)
"""Width and height of a thumbnail, pixels."""
COARSE = np.uint8(0xFC)
"""Mask of the colour bits that a thumbnail keeps: it is sent within a text of some ten thousand characters."""


def render(folder: Path, what: str, output: Path, chosen: Sequence[str] = ()) -> int:
    """Write the requested pictures; return the exit code."""
    try:
        from robbdd_tools.agent.video import NoVideo
        from robbdd_tools.world.picture import NoPicture, require_graphics
    except Exception as error:  # the engine selects its back end on import; each fails with its own exception type
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return NO_GRAPHICS
    try:
        manifest = read_manifest(folder)
        if what == THUMBNAILS:
            pictures = _thumbnails(folder, manifest, output, chosen)
        elif what in (MOMENTS, VIDEOS):
            output.mkdir(parents=True, exist_ok=True)
            pictures = (_moments if what == MOMENTS else _videos)(folder, manifest, output)
        else:
            pictures = _scene(manifest, int(what), output)
        require_graphics()
        for picture in pictures:
            print(picture, flush=True)
    except (SceneError, NoVideo) as error:
        print(error, file=sys.stderr)
        return FAILED
    except OSError as error:
        print(f"{error.filename or output}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    except NoPicture as error:
        print(error, file=sys.stderr)
        return NO_GRAPHICS
    return 0


def _scene(manifest: Manifest, index: int, output: Path) -> Iterator[Path]:
    yield from _pictures(manifest.scenarios[index], [(output, None)])


def _moments(folder: Path, manifest: Manifest, output: Path) -> Iterator[Path]:
    from robbdd_tools.agent.violation_states import ViolationStates

    for index, moments in groupby(ViolationStates(folder), key=lambda moment: moment.index):
        spec = manifest.scenarios[index]
        names, stem = _names(spec), _stem(spec)
        yield from _pictures(spec, ((output / f"{stem}-{names[moment.line]}.png", moment) for moment in moments))


def _thumbnails(folder: Path, manifest: Manifest, output: Path, chosen: Sequence[str]) -> Iterator[Path]:
    from robbdd_tools.agent.violation_states import ViolationStates

    output.mkdir(parents=True, exist_ok=True)
    wanted = {tuple(map(int, word.split(":"))) for word in chosen}
    moments = [moment for moment in ViolationStates(folder) if (moment.index, moment.line) in wanted]
    for index, group in groupby(moments, key=lambda moment: moment.index):
        pictures = ((thumbnail_file(output, index, moment.line), moment) for moment in group)
        yield from _pictures(manifest.scenarios[index], pictures, small=True)


def _videos(folder: Path, manifest: Manifest, output: Path) -> Iterator[Path]:
    from robbdd_tools.agent.execution import Execution
    from robbdd_tools.agent.shared_executions import calls_of, timing_of
    from robbdd_tools.agent.video import Violation, write_video
    from robbdd_tools.agent.violation_states import ViolationStates
    from robbdd_tools.judging.scenario_clauses import clause_of

    moments = list(ViolationStates(folder))
    for index, spec in enumerate(manifest.scenarios):
        names = _names(spec)
        clauses = [clause_of(clause, spec) for clause in spec.clauses if clause.role != "when"]
        execution = Execution(spec, calls_of(spec), timing_of(spec, clauses))
        execution.advance_until(lambda _: False)
        violations = [Violation(moment.at, names[moment.line]) for moment in moments if moment.index == index]
        path = output / f"{_stem(spec)}.webp"
        write_video(path, execution, _stem(spec), violations)
        yield path


def _names(spec: ScenarioSpec) -> dict[int, str]:
    """Return the name of each clause by its feature line; behaviours are numbered if there are several."""
    behaviours = [clause.line for clause in spec.clauses if clause.role == "when"]
    many = len(behaviours) > 1
    found = {line: f"behaviour-{number}" if many else "behaviour" for number, line in enumerate(behaviours, start=1)}
    return {clause.line: found.get(clause.line, clause.name) for clause in spec.clauses}


def _stem(spec: ScenarioSpec) -> str:
    return safe_stem(spec.name.rpartition(":")[2].replace(" -- ", "-"))


def _pictures(
    spec: ScenarioSpec, wanted: Iterable[tuple[Path, ViolationState | None]], small: bool = False
) -> Iterator[Path]:
    """Write pictures of one scenario: of moments, or of the initial scene; yield their paths."""
    from robbdd_tools.agent.execution import Execution
    from robbdd_tools.agent.shared_executions import calls_of
    from robbdd_tools.world.picture import Camera
    from robbdd_tools.world.png import write_png

    calls = calls_of(spec)
    focus = next((call.element("object") for call in calls if "object" in call.arguments), None)
    simulation = Execution(spec, calls).simulation
    camera = Camera(simulation, (2 * SMALL[0], 2 * SMALL[1]), plain=True) if small else Camera(simulation)
    try:
        for path, moment in wanted:
            pixels = camera.take(simulation.data) if moment is None else camera.take_state(moment.state, focus)
            write_png(path, _halved(pixels) if small else pixels)
            yield path
    finally:
        camera.close()


def _halved(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return a picture of half the size in coarser colours; labels are halved, too."""
    height, width, _ = pixels.shape
    means = pixels.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3))
    return means.astype(np.uint8) & COARSE


def _main() -> int:
    try:
        folder, what, output, *chosen = sys.argv[1:]
        return render(Path(folder), what, Path(output), chosen)
    except (ValueError, IndexError) as error:
        print(f"{USAGE} ({error})", file=sys.stderr)
        return FAILED


if __name__ == "__main__":
    sys.exit(_main())
