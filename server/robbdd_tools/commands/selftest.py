"""Tests of ``robbdd doctor``. They execute commands of RobBDD on an example in processes with a time limit."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from robbdd_tools.base.files import load_text
from robbdd_tools.base.graphics import CHOICE, advice, back_ends
from robbdd_tools.base.interpreter import run_for
from robbdd_tools.base.processes import Ending, describe_exit
from robbdd_tools.base.scaffold import begin_project
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands.installation import REINSTALL, SECONDS, Unavailable
from robbdd_tools.run.database import DamagedDatabase, DatabaseProblem, inspect
from robbdd_tools.run.store import RESULTS, NoSuchRun, StoredRun, store_beside

EXAMPLE = "pickplace"
MODEL = f"{EXAMPLE}.bdd"
_TASK = "    task: <pick-place-task>\n"
_MISSING_TASK = "shacl-scenario-task"
_SESSION: tuple[Mapping[str, Any], ...] = (
    {"id": 1, "method": "initialize", "params": {"processId": None, "rootUri": None, "capabilities": {}}},
    {"method": "initialized", "params": {}},
    {"id": 2, "method": "shutdown"},
    {"method": "exit"},
)
_ENGINE = "python -m pip install --force-reinstall mujoco behave"


def models(folder: Path) -> str:
    """Create the example in ``folder``, parse and check it."""
    begin_project(folder, EXAMPLE)
    # A project of its own, even if the temporary folder is inside another project.
    (folder / "robbdd.toml").touch()
    done = _robbdd("check", folder)
    if done.code != 0:
        raise _broken("the example has errors", done)
    return done.output.splitlines()[-1]


def shapes(folder: Path) -> str:
    """Check that SHACL finds an error that no other check finds."""
    faulty = folder.with_name("faulty")
    begin_project(faulty, EXAMPLE)
    model = faulty / MODEL
    replace_file(model, load_text(model).replace(_TASK, ""))
    done = _robbdd("check", model)
    if _MISSING_TASK not in done.output:
        raise _broken("SHACL misses a planted fault", done)
    return "SHACL finds a planted fault"


def features(folder: Path) -> str:
    """Write the example's features."""
    target = folder.with_name("gherkin")
    done = _robbdd("gherkin", folder / MODEL, "-o", target)
    written = sorted(target.rglob("*.feature"))
    if done.code != 0 or not written or "Scenario" not in load_text(written[0]):
        raise _broken("no feature was written", done)
    return f"{written[0].name} with {len(load_text(written[0]).splitlines())} lines"


def simulation(folder: Path) -> str:
    """Execute one scenario of the example, and read its verdict from the example's store of runs."""
    done = _robbdd("run", folder / MODEL, "--first", "1", "--jobs", "1")
    try:
        run = store_beside(folder / MODEL).find("latest")
        (scenario,) = run.results()["scenarios"]
        engine = run.record().simulator
    except (NoSuchRun, ValueError) as error:
        raise _broken(f"no scenario was executed ({error})", done, _ENGINE) from None
    if scenario["verdict"] != "holds":
        raise _broken(f"{scenario['name']} is {scenario['verdict']}", done, _ENGINE)
    return f"{engine}: {scenario['name']} holds, kept as run {run.number} and read back"


def rendering(folder: Path) -> str:
    """Render the example's scene with the first graphics back end that works. Raises ``Unavailable`` if none works."""
    failures: list[str] = []
    for back_end in back_ends():
        picture = folder.with_name(f"{back_end}.png")
        done = _robbdd("view", folder / MODEL, "-o", picture, more={CHOICE: back_end})
        if done.code == 0 and picture.is_file():
            return f"{back_end}, {picture.stat().st_size} bytes of PNG"
        failures.append(f"{back_end}: {_last_line(done)}")
    raise Unavailable("\n".join(failures), f"{advice()} (only pictures need it)", optional=True)


def server(_: Path) -> str:
    """Start and end a session with the language server."""
    messages = "".join(map(_message, _SESSION))
    done = _python("robbdd_tools.lsp.main", "--stdio", sent=messages)
    if done.code != 0 or '"serverInfo"' not in done.output:
        raise _broken("the language server does not answer", done)
    return (
        "robbdd-lsp answers; its log is the Output channel 'RobBDD' in VS Code, else its standard error or --log-file"
    )


def store(path: Path) -> str:
    """Read all runs of a project's store, check its database, and test whether it is writable."""
    found = store_beside(path)
    folder = found.folder
    unreadable = [str(reason) for run in found.runs() if (reason := _unreadable(run)) is not None]
    existing = next(place for place in (folder, *folder.parents) if place.exists())
    try:
        with tempfile.TemporaryFile(dir=existing) as file:
            file.write(b"robbdd")
    except OSError as error:
        reason = f"{folder} cannot be written: {error.strerror or error}"
        raise Unavailable(reason, "change its permissions, or name another one with `--store DIR`") from None
    # A run may be unreadable because of the database; then report the database.
    database = f"; {found.database.name}: {_checked(found.database)}" if found.database.exists() else ""
    if unreadable:
        raise Unavailable("\n".join(unreadable), "delete these runs, or copy them again completely")
    return f"{folder}: {len(found.runs())} runs, writable{database}"


def _checked(database: Path) -> str:
    try:
        return f"schema {inspect(database)}, integrity checked, writable"
    except DamagedDatabase as problem:
        fix = f"move it away: the next run begins a new one, and runs with a {RESULTS} can still be read"
        raise Unavailable(str(problem), fix) from None
    except DatabaseProblem as problem:
        raise Unavailable(str(problem), "name another store with `--store DIR`") from None


def _unreadable(run: StoredRun) -> NoSuchRun | None:
    try:
        run.record()
        run.results()
        run.manifest()
    except NoSuchRun as reason:
        return reason
    return None


def _robbdd(command: str, *arguments: str | Path, more: Mapping[str, str] | None = None) -> Ending:
    return _python("robbdd_tools.cli", command, *map(str, arguments), more=more)


def _python(module: str, *arguments: str, more: Mapping[str, str] | None = None, sent: str = "") -> Ending:
    return run_for(SECONDS, module, *arguments, more=more, sent=sent)


def _message(content: Mapping[str, object]) -> str:
    body = json.dumps({"jsonrpc": "2.0", **content})
    return f"Content-Length: {len(body)}\r\n\r\n{body}"


def _broken(problem: str, done: Ending, fix: str = REINSTALL) -> Unavailable:
    return Unavailable(f"{problem}: {_last_line(done)}", fix)


def _last_line(done: Ending) -> str:
    """Return how a command ended, and its last line of output."""
    ending = f"ended after {SECONDS:g} s" if done.code is None else describe_exit(done.code)
    lines = [line.strip() for line in (done.errors or done.output).splitlines() if line.strip()]
    return f"{lines[-1]} ({ending})" if lines else ending


TESTS: Mapping[str, Callable[[Path], str]] = {
    "models": models,
    "shapes": shapes,
    "features": features,
    "simulation": simulation,
    "rendering": rendering,
    "server": server,
}
"""The tests in execution order. The first one creates the folder that the others use."""
