"""Server and extension have the same version: the extension installs the server of its own version."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest

from kit import ROOT
from robbdd_tools import __version__

CLIENT = ROOT / "client-vscode"


def test_the_distribution_has_the_version_that_the_commands_tell() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == __version__


def test_the_extension_and_its_lock_file_have_the_version_of_the_server() -> None:
    manifest = json.loads((CLIENT / "package.json").read_text(encoding="utf-8"))
    locked = json.loads((CLIENT / "package-lock.json").read_text(encoding="utf-8"))
    assert manifest["version"] == locked["version"] == locked["packages"][""]["version"] == __version__


@pytest.mark.parametrize("path", [CLIENT / "CHANGELOG.md", ROOT / "docs" / "changelog.md"], ids=["client", "package"])
def test_each_changelog_begins_with_that_version(path: Path) -> None:
    changelog = path.read_text(encoding="utf-8")
    newest = next(line for line in changelog.splitlines() if line.startswith("## "))
    assert newest == f"## {__version__}"
