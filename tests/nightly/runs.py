"""Fuzzing of the outputs and inputs of runs: store, traces, messages, models of the simulator."""

from __future__ import annotations

import shutil
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path
from random import Random

from tests.nightly.commands import robbdd
from tests.nightly.fuzz import Files, Target, read_case
from tests.nightly.mutate import damaged_bytes, damaged_text, encoded

from kit import EXAMPLES
from robbdd_tools.catalog.executable import ArmModel, ModelSource
from robbdd_tools.run.database import NAME as DATABASE
from robbdd_tools.run.database import DatabaseProblem, inspect
from robbdd_tools.run.store import store_beside

PROJECT = EXAMPLES / "pickplace"
MODEL = "pickplace.bdd"
URDF = """<robot name="five">
  <link name="foot"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><cylinder radius="0.08" length="0.04"/></geometry></collision></link>
  <link name="hand"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="yaw" type="revolute"><parent link="foot"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="10" velocity="1"/></joint>
</robot>
"""
NOISY = """import os


def apart(**_):
    with open({noise!r}, "rb") as file:
        noise = file.read()
    for descriptor in range(1, 32):
        try:
            os.write(descriptor, noise)
        except OSError:
            pass
    return True
"""
NOISE = (
    b'{"type": "ClauseJudged", "index": 0, "line": 1}',
    b'{"type": "RunFinished", "ok": true}\n',
    b'{"type": "ScenarioFinished", "index": 99, "simulated": 1, "wall": 1, "stepping": 1}\n',
    b'{"type": "LogLine", "level": "error", "text": "forged"}\n',
    b"[1, 2, 3]\n",
    b"\xff\xfe\x00\n",
    b"no line end",
    b"nul" * 2000,
    b"\n\n\n",
)


@cache
def _stored() -> Files:
    """Return the files of a project in which one scenario was run and stored."""
    with tempfile.TemporaryDirectory(prefix="robbdd-fuzz-") as name:
        folder = Path(name) / "project"
        shutil.copytree(PROJECT, folder)
        (folder / "robbdd.toml").write_bytes(b"")
        done = robbdd(folder, "run", MODEL, "--seed", "1")
        assert done.code in (0, 1), done.errors
        return read_case(folder)


def _damaged_store(random: Random) -> Files:
    files = dict(_stored())
    kept = [name for name in files if ".robbdd" in name]
    databases = [name for name in kept if name.rpartition("/")[2].startswith(DATABASE)]
    for _ in range(random.randrange(1, 4)):
        name = random.choice(random.choice((kept, databases)))
        if random.random() < 0.15:
            files.pop(name, None)
        elif name in files:
            files[name] = damaged_bytes(random, files[name])
    return {**files, "case.txt": str(random.random()).encode()}


def _check_store(folder: Path) -> None:
    """Every command that reads stored runs answers or reports an error."""
    database = store_beside(folder).database
    if database.exists():
        with suppress(DatabaseProblem):
            inspect(database)
    robbdd(folder, "runs")
    robbdd(folder, "query", MODEL, "ASK { ?s ?p ?o }", "--results", "latest")
    robbdd(folder, "graph", MODEL, "--results", "latest")
    if float((folder / "case.txt").read_text()) < 0.2:
        # These start processes: one case in five is enough.
        robbdd(folder, "judge", "latest", MODEL)
        robbdd(folder, "run", MODEL, "--rerun-failed")


def _damaged_trace(random: Random) -> Files:
    files = _stored()
    return {"case.mcap": damaged_bytes(random, next(data for name, data in files.items() if name.endswith(".mcap")))}


def _check_trace(folder: Path) -> None:
    """A trace is read whole, or refused."""
    from robbdd_tools.traces.mcap_file import SCHEMAS, UnreadableTrace, read_trace, read_views

    path = folder / "case.mcap"
    with suppress(UnreadableTrace):
        read_trace(path)
    with suppress(UnreadableTrace):
        read_views(path, list(SCHEMAS))


def _damaged_model(random: Random) -> Files:
    ending = random.choice(("xml", "xml", "urdf"))
    text = URDF if ending == "urdf" else (EXAMPLES / "ownrobot" / "five.xml").read_text(encoding="utf-8")
    return {f"case.{ending}": encoded(damaged_text(random, text, [text, URDF]))}


def _check_model(folder: Path) -> None:
    """A model file of the simulator is read, or refused."""
    from robbdd_tools.world.errors import SceneError
    from robbdd_tools.world.model_files import load, object_from
    from robbdd_tools.world.robot_files import robot_from

    path = next(folder.glob("case.*"))
    arm = ArmModel("tcp" if path.suffix == ".xml" else "hand", "grip", 0.04, 0.0, ("left_pad", "right_pad"), 0.08)
    source = ModelSource("urn:m", "urdf" if path.suffix == ".urdf" else "mjcf", "file", str(path), arm=arm)
    for read in (lambda: object_from(load(source), source, "", ("tray_ws",)), lambda: robot_from(source, "five")):
        with suppress(SceneError):
            read()


def _noise(random: Random) -> Files:
    files = {path.name: path.read_bytes() for path in PROJECT.iterdir() if path.is_file()}
    noise = b"".join(random.choice(NOISE) for _ in range(random.randrange(1, 8)))
    return {**files, "noise.bin": damaged_bytes(random, noise) if random.random() < 0.5 else noise}


def _check_channel(folder: Path) -> None:
    """What user code writes to any descriptor neither hangs a run nor breaks it off without a word."""
    (folder / "policies.py").write_text(NOISY.format(noise=str(folder / "noise.bin")), encoding="utf-8")
    done = robbdd(folder, "run", "pickplace.bddx", "--no-store", "--timeout", "30", "--jobs", "1")
    assert "scenario" in done.output + done.errors, "a run ends without a summary"


RUN_TARGETS = (
    Target("store", _damaged_store, _check_store),
    Target("trace", _damaged_trace, _check_trace),
    Target("simulator-model", _damaged_model, _check_model),
    Target("channel", _noise, _check_channel),
)
