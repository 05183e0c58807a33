"""``--no-user-code`` refuses whatever would run Python code that came with a model, before anything of it runs."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from kit import EXAMPLES

pytestmark = pytest.mark.physics


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copytree(EXAMPLES / "pickplace", tmp_path / "models")
    marker = tmp_path / "ran"
    policies = tmp_path / "models" / "policies.py"
    policies.write_text(f"{policies.read_text(encoding='utf-8')}\nopen({str(marker)!r}, 'w')\n", encoding="utf-8")
    return tmp_path / "models"


def robbdd(folder: Path, command: str) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-P", "-m", "robbdd_tools.cli", *command.split()]
    return subprocess.run(words, capture_output=True, encoding="utf-8", cwd=folder)


def test_evaluators_of_users_are_refused(folder: Path) -> None:
    assert robbdd(folder, "run pickplace.bddx --first 1 --store runs").returncode in (0, 1)
    (folder.parent / "ran").unlink()
    shutil.copytree(folder / "runs", folder / "before")
    for command in ("run pickplace.bddx --first 1", "judge latest pickplace.bddx", "replay latest --force"):
        done = robbdd(folder, f"{command} --store runs --no-user-code")
        assert done.returncode == 2, command
        assert "starts-outside judges by the Python code policies:apart" in done.stderr, command
        assert "leave out --no-user-code if you trust this code" in done.stderr
    assert not (folder.parent / "ran").exists()
    assert sorted(path.name for path in (folder / "runs").iterdir()) == sorted(
        path.name for path in (folder / "before").iterdir()
    )


def test_steps_of_users_are_refused_at_their_file(folder: Path) -> None:
    (folder / "steps").mkdir()
    steps = folder / "steps" / "pickplace_steps.py"
    steps.write_text(f"open({str(folder.parent / 'ran')!r}, 'w')\n", encoding="utf-8")
    done = robbdd(folder, "run pickplace.bdd --first 1 --no-store --no-user-code")
    assert done.returncode == 2
    assert f"{steps} holds steps of users" in done.stderr
    assert not (folder.parent / "ran").exists()


def test_what_does_without_code_of_users_is_run(folder: Path) -> None:
    assert robbdd(folder, "run pickplace.bdd --first 1 --no-store --no-user-code").returncode in (0, 1)
    assert robbdd(folder, "view pickplace.bddx -o scene.png --no-user-code").returncode in (0, 2)
    assert not (folder.parent / "ran").exists()
