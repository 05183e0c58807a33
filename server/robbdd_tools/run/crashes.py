"""Find the user's code that an agent process was executing when it crashed, was killed or took too long."""

from __future__ import annotations

import linecache
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import dropwhile
from pathlib import Path

from robbdd_tools.base.files import load_bytes
from robbdd_tools.monitor.fault import Fault, Frame
from robbdd_tools.protocol.fault_places import is_library, is_ours, original
from robbdd_tools.protocol.run_folder import call_file, dump_file
from robbdd_tools.protocol.specs import ScenarioSpec

_THREAD = re.compile(r"(Current thread|Thread|Stack)\b.*\(most recent call first\):")
_CALL = re.compile(r'  File "(.*)", line (\d+) in (.*)')
_ESCAPE = re.compile(r"\\(?:x([0-9a-f]{2})|u([0-9a-f]{4})|U([0-9a-f]{8}))")


@dataclass(frozen=True, slots=True)
class Crash:
    """The user's code that an agent process was executing when it ended.

    - ``calls``: the call stack of the process, outermost call first.
    - ``code``: the name of the called user code.
    - ``definition``: the place where that code is defined.

    An attribute is empty if it is unknown.
    """

    calls: tuple[Frame, ...] = ()
    code: str = ""
    definition: tuple[Frame, ...] = ()

    def fault(self, message: str, spec: ScenarioSpec | None, sources: Mapping[str, str]) -> Fault | None:
        """Return the crash as an error in the user's code, or ``None`` if the crash is not known to be in that code.

        ``message`` says how the process ended. ``sources`` maps the absolute path of each copied file of steps to the
        path of the original.
        """
        calls = _from_own(self.calls) or _from_own(self.definition)
        if not (calls or self.code):
            return None
        fault = original(Fault("", message, self.code, calls, _origin(self.code, spec)), sources)
        first = fault.frames[0] if not self.code else None
        return fault if first is None else replace(fault, code=f"{Path(first.file).stem}:{first.function}")


def take_crash(base: Path, folder: Path) -> Crash:
    """Read and delete the crash files of an agent process that worked in ``folder``.

    ``base`` is the value of the environment variable ``CRASH``: the common beginning of the paths of the crash files.
    """
    dumped, noted = _take(dump_file(base)), _take(call_file(base))
    code, file, line, *_ = (*noted.decode("utf-8", "replace").split("\0"), "", "", "")
    definition = (_frame(str(folder / file), line),) if line.isdecimal() else ()
    return Crash(tuple(reversed(list(_calls(dumped.decode("ascii", "replace"), folder)))), code, definition)


def _from_own(frames: tuple[Frame, ...]) -> tuple[Frame, ...]:
    """Return the calls from the first call into the user's code on, without the calls of this package."""
    kept = (frame for frame in frames if not is_ours(frame.file) and not Path(frame.file).name.startswith("<"))
    return tuple(dropwhile(lambda frame: not frame.own, kept))


def _take(path: Path) -> bytes:
    try:
        return load_bytes(path)
    except OSError:
        return b""
    finally:
        with suppress(OSError):
            path.unlink()


def _calls(dump: str, folder: Path) -> Iterator[Frame]:
    """Yield the calls of the crashed thread, innermost first. If no thread is marked as crashed, use the main thread.

    Relative file names in the dump are relative to ``folder``.
    """
    threads: list[tuple[str, list[Frame]]] = []
    for line in dump.splitlines():
        if found := _THREAD.match(line):
            threads.append((found[1], []))
        elif threads and (found := _CALL.match(line)):
            threads[-1][1].append(_frame(_existing(folder, found[1]), found[2], found[3]))
    crashed = [frames for kind, frames in threads if kind != "Thread"]
    # The interpreter lists its threads from the youngest to the main one.
    every = crashed or [frames for _, frames in threads]
    yield from every[-1] if every else ()


def _existing(folder: Path, file: str) -> str:
    """Return the path of a file that a dump names.

    A dump escapes non-ASCII letters as Python does, but it does not escape backslashes.
    """
    path = folder / file
    if not path.exists():
        path = folder / _ESCAPE.sub(lambda found: chr(int(found[1] or found[2] or found[3], 16)), file)
    return os.path.normpath(path)


def _frame(file: str, line: str, function: str = "") -> Frame:
    number = int(line)
    linecache.checkcache(file)
    return Frame(file, number, function, linecache.getline(file, number).strip(), not is_library(file))


def _origin(code: str, spec: ScenarioSpec | None) -> str:
    """Return the IRI of the element that names the code in the model. It is empty for code of steps."""
    if spec is None:
        return ""
    named: list[tuple[str, str]] = []
    if spec.tree is not None and spec.tree.source is not None:
        named.append((spec.tree.source.name, spec.tree.source.iri))
    execution = spec.execution
    if execution is not None:
        named.append((execution.implementation.name, execution.implementation.iri))
        named += [(policy.rule.name, policy.iri) for policy in execution.policies]
    scene = spec.instance
    if scene is not None:
        named += [(model.name, model.iri) for model in scene.sources]
    return dict(reversed(named)).get(code, "")
