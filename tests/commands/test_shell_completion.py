"""The script of ``robbdd completion`` completes commands, options, choices and files in a shell."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from kit import command_names
from robbdd_tools.cli import main

BASH = shutil.which("bash")


@pytest.mark.skipif(BASH is None, reason="there is no bash on this machine")
@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("ru", {"run", "runs"}),
        ("run --pairw", {"--pairwise"}),
        ("graph --format json", {"json-ld", "json-ld-expanded"}),
        ("check cel", {"cell.bdd"}),
        ("", command_names()),
    ],
)
def test_bash_offers_what_may_follow(
    words: str, offered: set[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", "bash"]) == 0
    (tmp_path / "script").write_text(capsys.readouterr().out, encoding="utf-8")
    (tmp_path / "cell.bdd").touch()
    typed = ["robbdd", *words.split(" ")]
    asked = (
        f"source ./script; COMP_WORDS=({' '.join(word or chr(34) * 2 for word in typed)}); COMP_CWORD={len(typed) - 1}"
    )
    ask = f'{asked}; _shtab_robbdd; printf "%s\\n" "${{COMPREPLY[@]}}"'
    done = subprocess.run([str(BASH), "-c", ask], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert offered <= set(done.stdout.split())
    assert words == "" or offered == set(done.stdout.split())


@pytest.mark.parametrize("shell", ["zsh", "tcsh"])
def test_other_shells_have_a_script(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    printed = capsys.readouterr().out
    assert [name for name in command_names() if name not in printed] == []
