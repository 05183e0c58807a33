"""``robbdd replay``: simulate a stored run again and prove that the traces are the same to the last bit."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.interpreter import run
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import execute
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.requests import digest, load_models
from robbdd_tools.commands.runs import say_unfinished, store_at
from robbdd_tools.run import user_code
from robbdd_tools.run.manifest import MANIFEST
from robbdd_tools.run.prepare import FEATURES
from robbdd_tools.run.protocol import trace_file
from robbdd_tools.run.results import finished_in
from robbdd_tools.run.store import NoSuchRun
from robbdd_tools.run.used_files import changed

if TYPE_CHECKING:
    from robbdd_tools.run.protocol import Manifest
    from robbdd_tools.run.scheduler import Policy
    from robbdd_tools.run.store import RunRecord, StoredRun


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """The run (a number, ``latest`` or a folder), the scenarios by name, where runs are kept, how to simulate.

    ``force`` simulates with files as they are now, changed or not.
    """

    run: str
    policy: Policy
    names: Sequence[str] = ()
    store: Path | None = None
    force: bool = False


def replay(options: ReplayOptions) -> int:
    """Print for each scenario whether its trace is the same; returns 0 when all are, 1 when one is not."""
    try:
        stored = store_at(Path(), options.store).find(options.run)
        record, manifest, status = stored.record(), stored.manifest(), stored.status()
        finished = finished_in(stored.results())
    except NoSuchRun as error:
        return fail(str(error))
    refusal = "" if options.force else _refusal(stored, record)
    if refusal:
        return fail(refusal)
    problem = user_code.refusal(manifest, stored.folder)
    if problem:
        return fail(problem)
    wanted = [
        index
        for index, spec in enumerate(manifest.scenarios)
        if not options.names or {spec.name, _local(spec.name), _local(spec.variant)} & set(options.names)
    ]
    say_unfinished(stored, status)
    wanted = [index for index in wanted if index in finished]
    indices = [index for index in wanted if trace_file(stored.folder, index).is_file()]
    if not indices:
        return fail(f"run {options.run} keeps no trace of {' or '.join(options.names) or 'any scenario'}")
    with tempfile.TemporaryDirectory(prefix="robbdd-") as name:
        folder = Path(name)
        _copy(stored.folder / MANIFEST, folder / MANIFEST)
        shutil.copytree(stored.folder / FEATURES, folder / FEATURES, ignore=_links, copy_function=_copy)
        executed = execute(folder, manifest, options.policy, indices)
        if executed.signal:
            return signal_code(executed.signal)
        simulator = status.simulator or record.simulator
        if simulator != executed.simulator:
            print_note(f"robbdd: the run was made with {simulator}, this is {executed.simulator}")
        for index in sorted({*wanted}.difference(indices)):
            print_line(f"{manifest.scenarios[index].name}: the run kept no trace of it")
        return _compare(stored, folder, manifest, indices)


def _refusal(stored: StoredRun, record: RunRecord) -> str:
    """Say why a run cannot be replayed; nothing when it can."""
    others = [os.path.relpath(path) for path in changed(record.files, stored.folder)]
    if others:
        verb = "was" if len(others) == 1 else "were"
        return f"{', '.join(others)} {verb} changed since the run: run it again, or go on with --force"
    path = stored.model()
    if not path.exists():
        return f"the model of the run, {record.path}, is gone"
    models = load_models(path)
    if models is None:
        return f"the model of the run, {record.path}, cannot be run as it is now"
    if digest(models) != record.digest:
        return (
            f"{record.path} was changed since the run (its graph's digest is {digest(models)[:12]}, "
            f"the run's {record.digest[:12]}): run it again, judge the stored traces with 'robbdd judge', "
            "or replay the run's own scenarios with --force"
        )
    return ""


def _compare(stored: StoredRun, folder: Path, manifest: Manifest, indices: Sequence[int]) -> int:
    done = run("robbdd_tools.agent.compare", str(stored.folder.absolute()), str(folder))
    if done.returncode:
        return fail(f"the traces cannot be compared: {(done.stderr.strip().splitlines() or [''])[-1]}")
    found = {entry["index"]: entry["difference"] for entry in map(json.loads, done.stdout.splitlines())}
    same = 0
    for index in indices:
        difference = found.get(index, "it could not be simulated again")
        same += not difference
        print_line(f"{manifest.scenarios[index].name}: {difference or 'the same to the last bit'}")
    print_line(f"{same} of {len(indices)} traces are the same")
    return OK if same == len(indices) else FINDINGS


def _local(name: str) -> str:
    return name.replace("#", "/").rpartition("/")[2].rpartition(":")[2]


def _copy(source: str | Path, target: str | Path) -> None:
    replace_file(Path(target), load_bytes(Path(source), RESULT_SIZE))


def _links(folder: str, names: list[str]) -> list[str]:
    """Return the links of a folder: a run that we wrote has none."""
    return [name for name in names if (Path(folder) / name).is_symlink()]
