"""A cell with the log of a drive, and executions that name it."""

from __future__ import annotations

import shutil
from pathlib import Path

from kit import EXAMPLES
from logs.bags import write
from logs.drives import drive
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.project import Project, Snapshot

HEAD = """import "pickplace.bdd"
import "bench.scenex"
ns exec = 'https://example.org/robbdd/execution/'
bhv impl (ns=exec) server { bhv action: "/pick" }
"""
EXECUTION = """
Scenario Exec (ns=exec) real { variant: <tidy-bench.part-to-bin> scene inst: <bench_sim> bhv: <server> log: <monday> }
"""
WHERE = "where <pick-place.thing> = <cubes.cube0> and <pick-place.goal> = <places.left_ws>"


def named(entries: str = "", where: str = WHERE, path: str = "drive") -> str:
    """Return a ``.bddx`` with a robot log."""
    return f'{HEAD}robot log (ns=exec) monday {{\n    path: "{path}"\n    {where}\n    {entries}\n}}\n{EXECUTION}'


def cell(folder: Path, text: str, cube: str = "cube0") -> Path:
    """Write the models of a cell, the log of a drive and a ``.bddx``; return the ``.bddx``."""
    models = shutil.copytree(EXAMPLES / "pickplace", folder / "models")
    write(models / "drive", drive(cube=cube))
    path = models / "real.bddx"
    path.write_text(text, encoding="utf-8")
    return path


def opened(path: Path) -> tuple[Snapshot, str]:
    """Return a snapshot in which a file is open, and its URI."""
    project, uri = Project(), path_to_uri(path)
    project.load(uri)
    return project.snapshot(), uri
