"""Whoever builds a release from the same sources gets the same bytes: elsewhere, later, with another umask."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import pytest

from kit import ROOT
from robbdd_tools import __version__

pytestmark = [pytest.mark.packaging, pytest.mark.skipif(sys.platform == "win32", reason="modes of files")]
CLIENT = ROOT / "client-vscode"
EPOCH = {"SOURCE_DATE_EPOCH": "1700000000"}
JUNK = ("__pycache__", ".*", "build", "dist", "node_modules", "out", "*.vsix")


def checkout(folder: Path, file_mode: int, folder_mode: int, time: int) -> Path:
    """Copy the sources as another person would have them."""
    shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*JUNK))
    shutil.copy(ROOT / ".gitignore", folder)
    shutil.copy(CLIENT / ".vscodeignore", folder / "client-vscode")
    for path in (folder, *folder.rglob("*")):
        path.chmod(folder_mode if path.is_dir() else file_mode)
        os.utime(path, (time, time))
    return folder


@pytest.fixture(scope="module")
def checkouts(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("two")
    one = checkout(folder / "one", 0o600, 0o700, 1_000_000_000)
    other = checkout(folder / "another place" / "other", 0o664, 0o775, 1_600_000_000)
    for junk in ("__pycache__/policies.cpython-311.pyc", ".robbdd/runs/1/run.json"):
        path = other / "examples" / "pickplace" / junk
        path.parent.mkdir(parents=True)
        path.write_text("left by somebody's run", encoding="utf-8")
    return one, other


def digests(folder: Path) -> dict[str, str]:
    return {path.name: sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


def test_wheel_and_source_distribution(checkouts: tuple[Path, Path], tmp_path: Path) -> None:
    for number, (source, umask) in enumerate(zip(checkouts, (0o077, 0o002), strict=True)):
        command = [sys.executable, "-m", "build", "--outdir", tmp_path / str(number), source]
        zone = {"TZ": ("UTC", "Asia/Tokyo")[number]}
        subprocess.run(command, check=True, capture_output=True, umask=umask, env={**os.environ, **EPOCH, **zone})
    built = digests(tmp_path / "0")
    assert len(built) == 2
    assert built == digests(tmp_path / "1")


@pytest.mark.nightly
@pytest.mark.skipif(not (CLIENT / "node_modules").is_dir(), reason="needs `make setup`")
def test_vsix(checkouts: tuple[Path, Path]) -> None:
    packed: list[bytes] = []
    for source, umask in zip(checkouts, (0o077, 0o002), strict=True):
        client = source / "client-vscode"
        (client / "node_modules").symlink_to(CLIENT / "node_modules")
        command = ["npm", "run", "--silent", "package"]
        environment = {**os.environ, **EPOCH, "PYTHON": sys.executable}
        subprocess.run(command, cwd=client, check=True, capture_output=True, umask=umask, env=environment)
        packed.append((client / "robbdd-workbench.vsix").read_bytes())
    assert packed[0] == packed[1]
    with ZipFile(BytesIO(packed[0])) as archive:
        wheels = [name for name in archive.namelist() if ".whl" in name]
    assert wheels == [f"extension/out/server/robbdd_tools-{__version__}-py3-none-any.whl.br"]
