"""Fuzzing of the language: parser with every feature of the editor, and formatter."""

from __future__ import annotations

import re
import zlib
from pathlib import Path
from random import Random

from tests.nightly.commands import robbdd
from tests.nightly.fuzz import Files, Target
from tests.nightly.mutate import any_text, damaged_bytes, damaged_text, encoded

from features.test_any_text import ask_everything
from kit import MODEL, MODELS, SCENE
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri, read_text
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.layout import lay_out
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project, Snapshot

LAYOUT = re.compile(r"[\s\-|]")
"""What layout puts in and takes out: white space, and the lines and rules of tables."""
PLACES = 4
"""Cursors in each text."""
SMALL = {"main.bdd": MODEL, "lab.scene": SCENE}
PROJECTS = [SMALL] + [
    {path.name: path.read_text(encoding="utf-8") for path in MODELS if path.parent == folder}
    for folder in sorted({path.parent for path in MODELS})
]
"""Models that belong together, by file name."""
ALL = [text for project in PROJECTS for text in project.values()]
NAME = "case.txt"
"""The file of a case that names the damaged one."""


def project_with(random: Random) -> tuple[dict[str, bytes], str]:
    """Return the files of a project of ours and the name of one that is to be damaged."""
    project = random.choice(PROJECTS)
    name = random.choice(sorted(project))
    return {**{file: encoded(text) for file, text in project.items()}, NAME: name.encode()}, name


def _damaged(random: Random) -> Files:
    files, name = project_with(random)
    text = files[name].decode()
    match random.randrange(10):
        case 0:
            files[name] = bytes(random.randrange(256) for _ in range(random.randrange(300)))
        case 1:
            files[name] = encoded(any_text(random))
        case 2:
            files[name] = damaged_bytes(random, files[name])
        case _:
            files[name] = encoded(damaged_text(random, text, ALL))
    return files


def _check_parser(folder: Path) -> None:
    """A command reports about any bytes; every feature of the editor answers on any text."""
    path = folder / (folder / NAME).read_text(encoding="utf-8")
    done = robbdd(folder, "check", "--json", path.name)
    text = read_text(path)
    if not isinstance(text, str):
        assert done.code == 2, f"check ends with {done.code} though {text.reason}"
        text = path.read_bytes().decode("utf-8", "surrogateescape")
    project, uri = Project(), path_to_uri(path)
    project.open(uri, 1, text)
    if project.snapshot().file(uri) is None:
        return
    random = Random(zlib.crc32(path.read_bytes()))
    ask_everything(project.snapshot(), uri, [random.randrange(len(text) + 1) for _ in range(PLACES)])


def _respaced(random: Random) -> Files:
    """A model, sound or damaged, with white space changed at random."""
    files, name = project_with(random)
    text = files[name].decode()
    if random.random() < 0.4:
        text = damaged_text(random, text, ALL, times=2)
    pieces: list[str] = []
    for letter in text:
        pieces.append(letter)
        if letter == " " and random.random() < 0.05:
            pieces.append(random.choice((" ", "\t", "   ", "\n")))
    files[name] = encoded("".join(pieces))
    return files


def _check_formatter(folder: Path) -> None:
    """Layout is idempotent, changes white space only, and neither graph nor findings of a sound text."""
    path = folder / (folder / NAME).read_text(encoding="utf-8")
    text = read_text(path)
    if not isinstance(text, str):
        return
    laid_out = lay_out(text)
    assert lay_out(laid_out) == laid_out, "the layout of a laid-out text differs"
    assert LAYOUT.sub("", laid_out) == LAYOUT.sub("", text), "layout changes more than white space"
    uri = path_to_uri(path)
    before, after = _snapshot(uri, text), _snapshot(uri, laid_out)
    if any(finding.severity is Severity.ERROR for finding in fast_diagnostics(before, uri)):
        return
    assert _codes(before, uri) == _codes(after, uri), "layout changes the findings"
    graphs = (serialize(build_graph(snapshot, uri).graph, "nt") for snapshot in (before, after))
    assert len(set(graphs)) == 1, "layout changes the graph"


def _snapshot(uri: str, text: str) -> Snapshot:
    project = Project()
    project.open(uri, 1, text)
    return project.snapshot()


def _codes(snapshot: Snapshot, uri: str) -> list[tuple[str, str]]:
    return sorted((found.code, found.message) for found in fast_diagnostics(snapshot, uri))


LANGUAGE_TARGETS = (
    Target("parser", _damaged, _check_parser),
    Target("formatter", _respaced, _check_formatter),
)
