"""One mutmut session for one room, in a folder with a copy of the files that the room's tests read."""

from __future__ import annotations

import ast
import json
import os
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.mutants.rooms import Room

ROOT = Path(__file__).parent.parent.parent
WORK = ROOT / "build" / "mutants"
"""Parent folder of the rooms' sessions; mutmut keeps its results there."""

_READ = ("tests", "grammar", "metamodels", "examples", "docs")
_SETTINGS = """
[tool.mutmut]
source_paths = ["src/robbdd_tools"]
only_mutate = {modules}
pytest_add_cli_args_test_selection = {tests}
pytest_add_cli_args = ["-p", "no:cacheprovider", "-p", "tests.mutants.quickest_first", "--hypothesis-profile=mutants"]
also_copy = {read}
timeout_constant = {seconds}
timeout_multiplier = 4.0
process_isolation = "forkserver"
use_git_change_detection = false
"""
_QUICK = {"CI": "1", "ROBBDD_FUZZ": "10"}
"""The same examples for every mutant; few sequences of edits, as each takes a third of a second."""
_PROGRESS = re.compile(r"^[⠀-⣿].*\n", re.MULTILINE)
"""The lines of mutmut's spinner."""
_HUNK = re.compile(r"^@@ -(\d+)")


class SessionFailed(Exception):
    """mutmut could not measure a room, for instance because a test fails without a mutant; has mutmut's output."""


@dataclass(frozen=True)
class Mutant:
    """A mutant with its result."""

    name: str
    """As mutmut calls it, with the module and the function."""
    status: str
    """As mutmut reports it: killed, timeout, survived, no tests, segfault …"""

    @property
    def is_killed(self) -> bool:
        return self.status in ("killed", "timeout", "segfault")


class Session:
    """Makes a room's mutants and runs the room's tests on them; edits of the checkout in the meantime change nothing.

    Args:
        room: what is mutated.
        seconds: how much longer than usual the tests of a mutant may take, a quarter of it, before it counts as killed.
    """

    def __init__(self, room: Room, seconds: float) -> None:
        self.folder = WORK / room.name
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        # mutmut finds modules below a folder of this name.
        for source, copy in (("server", "src"), *zip(_READ, _READ, strict=True)):
            shutil.copytree(ROOT / source, self.folder / copy, ignore=shutil.ignore_patterns("__pycache__", ".robbdd"))
        settings = _SETTINGS.format(
            modules=list(room.patterns), tests=list(room.tests), read=list(_READ), seconds=seconds / 4
        )
        project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
        (self.folder / "pyproject.toml").write_text(project + settings, encoding="utf-8")
        self._room = room

    def mutants(self) -> list[str]:
        """Return the names of all mutants of the room, sorted."""
        # mutmut reads its settings from the working directory, hence a process.
        program = (
            "from mutmut.mutation.file_mutation import mutate_file_contents\n"
            "from mutmut.utils.file_utils import walk_mutatable_files\n"
            "from mutmut.utils.format_utils import get_mutant_name\n"
            "for path in walk_mutatable_files():\n"
            "    for name in mutate_file_contents(str(path), path.read_text(encoding='utf-8')).mutant_names:\n"
            "        print(get_mutant_name(path, name))\n"
        )
        return sorted(self._output([sys.executable, "-c", program]).split())

    def run(self, names: Sequence[str]) -> list[Mutant]:
        """Test mutants; returns them in the order of their names.

        Raises:
            SessionFailed: the tests fail without a mutant.
        """
        self._mutmut("run", "--max-children", "1", *names)
        lines = self._mutmut("results", "--all", "true").splitlines()
        statuses = dict(line.strip().rsplit(": ", 1) for line in lines if ": " in line)
        return [Mutant(name, statuses[name]) for name in sorted(names)]

    def place(self, name: str, diff: str) -> str:
        """Return the place of a mutant's change, as ``path:line``."""
        module, _, function = name.partition("__mutmut_")[0].rpartition(".")
        path = f"{module.replace('.', '/')}.py"
        if not (self.folder / "src" / path).exists():
            path = f"{path.removesuffix('.py')}/__init__.py"
        first = first_line(ast.parse((self.folder / "src" / path).read_text(encoding="utf-8")), function)
        return f"server/{path}:{first + changed_line(diff)}"

    def diffs(self, names: Sequence[str]) -> dict[str, str]:
        """Return the changes of mutants as unified diffs of their functions, by name."""
        program = (
            "import json, sys\n"
            "from mutmut.mutation.diff_apply import get_diff_for_mutant\n"
            "print(json.dumps({name: get_diff_for_mutant(name) for name in sys.argv[1:]}))\n"
        )
        found: dict[str, str] = json.loads(self._output([sys.executable, "-c", program, *names]))
        return {name: "\n".join(diff.splitlines()[2:]) for name, diff in found.items()}

    def _mutmut(self, *arguments: str) -> str:
        return self._output([str(Path(sys.executable).with_name("mutmut")), *arguments])

    def _output(self, command: Sequence[str]) -> str:
        done = subprocess.run(
            command, cwd=self.folder, env=os.environ | _QUICK, capture_output=True, text=True, encoding="utf-8"
        )
        if done.returncode != 0:
            shown = _PROGRESS.sub("", f"{done.stdout}\n{done.stderr}")
            raise SessionFailed(f"{self._room.name}, in {self.folder}:\n{shown[-5000:]}")
        return done.stdout


def sample(names: Sequence[str], size: int | None, seed: int) -> list[str]:
    """Return that many random mutants, or all of them if there are no more or no size is given."""
    return list(names) if size is None or size >= len(names) else random.Random(seed).sample(list(names), size)


def first_line(module: ast.Module, function: str) -> int:
    """Return the line on which a function begins, which mutmut names ``x_name`` or ``xǁClassǁname``."""
    owner, _, name = function.removeprefix("x").lstrip("ǁ").rpartition("ǁ")
    body = module.body
    if owner:
        body = next(node.body for node in body if isinstance(node, ast.ClassDef) and node.name == owner)
    else:
        name = function.removeprefix("x_")
    found = (node for node in body if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name == name)
    return next(found).lineno


def changed_line(diff: str) -> int:
    """Return how many lines below the first line of the function the change begins."""
    lines = diff.splitlines()
    hunk = _HUNK.match(lines[0])
    changed = next(index for index, line in enumerate(lines[1:]) if line.startswith(("-", "+")))
    return (int(hunk[1]) if hunk else 1) - 1 + changed
