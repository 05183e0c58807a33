"""Long forms of tests that have a short form in the suite, and the versions that the dependency ranges allow."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
SEQUENCES = 20_000
VALIDATED = 200
"""Sequences of edits that are compared with a validation of the whole graph."""
KILLS = 1_000
SMOKE = (
    "tests/syntax/test_parse.py",
    "tests/syntax/test_oracle.py",
    "tests/names/test_resolve.py",
    "tests/graph/test_query.py",
    "tests/graph/test_serialize.py",
    "tests/graph/test_shapes.py",
    "tests/gherkin/test_templates.py",
    "tests/gherkin/test_variations.py",
    "tests/gherkin/test_select.py",
    "tests/graph/test_foreign.py",
    "tests/traces/test_mcap_file.py",
    "tests/logs/test_open_log.py",
    "tests/world/test_picture.py",
    "tests/agent/test_behaviour_tree.py",
    "tests/agent/test_process.py",
    "tests/pytest_plugin/test_collection.py",
    "tests/commands/test_cli.py",
    "tests/commands/test_progress.py",
    "tests/lsp/test_tokens.py",
    "tests/lsp/test_positions.py",
)
"""Tests that use each dependency at least once."""


def edits() -> str:
    """Edit models at random and compare with a fresh analysis and a fresh validation."""
    parts = (("names", SEQUENCES), ("graph", VALIDATED))
    return "; ".join(
        _pytest(f"tests/{part}/test_incremental.py", {"ROBBDD_FUZZ": str(count)})[-1] for part, count in parts
    )


def long_forms() -> str:
    """Execute the long forms of tests of the suite."""
    return _pytest("tests", {}, "-m", "nightly")[-1]


def kills() -> str:
    """Kill runs at random instants: no finished result is lost."""
    # With -s the test's own sentence is the first line.
    return _pytest("tests/run/test_kills.py", {"ROBBDD_KILLS": os.environ.get("ROBBDD_KILLS", str(KILLS))}, "-s")[0]


def versions() -> str:
    """Run a part of the tests with the lowest and with the newest versions that the dependency ranges allow."""
    return "; ".join(_with_versions(resolution) for resolution in ("lowest-direct", "highest"))


def _with_versions(resolution: str) -> str:
    with tempfile.TemporaryDirectory(prefix="robbdd-versions-") as name:
        folder = Path(name)
        python = folder / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
        _call(sys.executable, "-m", "venv", str(folder / "uv"))
        uv = folder / "uv" / python.parent.name / "uv"
        _call(str(uv.with_name("python")), "-m", "pip", "install", "--quiet", "uv")
        _call(str(uv), "venv", "--quiet", "--python", sys.executable, str(folder / "venv"))
        install = (str(uv), "pip", "install", "--quiet", "--python", str(python), "--resolution", resolution)
        _call(*install, "--editable", ".[video,fast-queries,logs,pytest]")
        # The tests' own tools are installed as they are newest, around the versions that are tested.
        frozen = folder / "frozen.txt"
        frozen.write_text(_call(str(uv), "pip", "freeze", "--python", str(python), "--exclude-editable"))
        _call(str(uv), "pip", "install", "--quiet", "--python", str(python), "-c", str(frozen), "--editable", ".[dev]")
        return f"{resolution}: {_call(str(python), '-m', 'pytest', '-q', '-x', '-n', '0', *SMOKE).splitlines()[-1]}"


def _pytest(path: str, environment: Mapping[str, str], *options: str) -> list[str]:
    return _call(sys.executable, "-m", "pytest", "-q", path, *options, environment=environment).splitlines()


def _call(*command: str, environment: Mapping[str, str] | None = None) -> str:
    """Run a command at the project's root and return its output; raises ``AssertionError`` with it on failure."""
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **(environment or {})}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{' '.join(command)} fails:\n{done.stdout[-3000:]}{done.stderr[-3000:]}"
    return done.stdout
