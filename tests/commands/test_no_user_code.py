"""``--no-user-code`` refuses all Python code of a model before any of it runs."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from kit import EXAMPLES

pytestmark = pytest.mark.physics

OWN_BEHAVIOUR = "bhv impl (ns=exec) built-in { py { module: policies, attr: Own } }"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copytree(EXAMPLES / "pickplace", tmp_path / "models")
    marker = tmp_path / "ran"
    policies = tmp_path / "models" / "policies.py"
    policies.write_text(f"{policies.read_text(encoding='utf-8')}\nopen({str(marker)!r}, 'w')\n", encoding="utf-8")
    return tmp_path / "models"


def replace(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def line_of(path: Path, words: str) -> int:
    """Return the number of the first line that holds ``words``."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines, start=1) if words in line)


def stored_runs(store: Path) -> list[str]:
    return sorted(path.name for path in store.iterdir() if path.is_dir())


def robbdd(folder: Path, command: str) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-P", "-m", "robbdd_tools.cli", *command.split()]
    return subprocess.run(words, capture_output=True, encoding="utf-8", cwd=folder)


def test_evaluators_of_users_are_refused(folder: Path) -> None:
    assert robbdd(folder, "run pickplace.bddx --first 1 --store runs").returncode in (0, 1)
    (folder.parent / "ran").unlink()
    shutil.copytree(folder / "runs", folder / "before")
    bddx = folder / "pickplace.bddx"
    for command in ("run pickplace.bddx --first 1", "judge latest pickplace.bddx", "replay latest --force"):
        done = robbdd(folder, f"{command} --store runs --no-user-code")
        assert done.returncode == 2, command
        place = re.escape(f"{bddx}:{line_of(bddx, 'obs policy (ns=exec) starts-outside')}:")
        words = rf"{place}\d+: the policy \S+starts-outside judges with the Python code policies:apart"
        assert re.search(words, done.stderr), (command, done.stderr)
        assert "leave out --no-user-code if you trust this code" in done.stderr
    assert not (folder.parent / "ran").exists()
    assert stored_runs(folder / "runs") == stored_runs(folder / "before")


def test_a_behaviour_and_a_model_of_users_are_refused_at_their_lines(folder: Path) -> None:
    bddx, scenex = folder / "pickplace.bddx", folder / "bench.scenex"
    replace(bddx, 'bhv impl (ns=exec) built-in { catalog "pick-place" }', OWN_BEHAVIOUR)
    replace(scenex, '{ catalog "cube" }', "{ py { module: policies, attr: block } }")
    behaviour = f"{bddx}:{line_of(bddx, OWN_BEHAVIOUR)}:20: a behaviour is the Python code policies:Own"
    model = f"{scenex}:{line_of(scenex, 'attr: block')}:"
    run = robbdd(folder, "run pickplace.bddx --first 1 --no-store --no-user-code")
    assert run.returncode == 2
    assert behaviour in run.stderr
    assert model in run.stderr
    view = robbdd(folder, "view pickplace.bddx -o scene.png --no-user-code")
    assert view.returncode == 2
    assert model in view.stderr
    assert "a model is created by the Python code policies:block" in view.stderr
    assert behaviour not in view.stderr, "a picture of the initial scene needs no behaviour"
    assert not (folder / "scene.png").exists()
    assert not (folder.parent / "ran").exists()


def test_steps_of_users_are_refused_at_their_file(folder: Path) -> None:
    (folder / "steps").mkdir()
    steps = folder / "steps" / "pickplace_steps.py"
    steps.write_text(f"open({str(folder.parent / 'ran')!r}, 'w')\n", encoding="utf-8")
    done = robbdd(folder, "run pickplace.bdd --first 1 --no-store --no-user-code")
    assert done.returncode == 2
    assert f"{steps} contains user-defined steps" in done.stderr
    assert not (folder.parent / "ran").exists()


def test_what_does_without_code_of_users_is_run(folder: Path) -> None:
    assert robbdd(folder, "run pickplace.bdd --first 1 --no-store --no-user-code").returncode in (0, 1)
    assert robbdd(folder, "view pickplace.bddx -o scene.png --no-user-code").returncode in (0, 2)
    assert not (folder.parent / "ran").exists()


def test_no_code_of_users_is_executed_with_faults(folder: Path) -> None:
    done = robbdd(folder, "mutate pickplace.bddx --no-user-code --fault no-grip")
    assert done.returncode == 2
    assert "judges with the Python code policies:apart" in done.stderr
    assert not (folder.parent / "ran").exists()


def test_a_study_executes_no_code_of_users(folder: Path) -> None:
    study = 'import "pickplace.bddx" Study one { first: 1 }'
    (folder / "one.study").write_text(study, encoding="utf-8")
    done = robbdd(folder, "study run one.study --no-user-code")
    assert done.returncode == 2
    assert "judges with the Python code policies:apart" in done.stderr
    assert not (folder.parent / "ran").exists()
