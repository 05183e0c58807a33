"""Options that another one replaces: they work for one version, and the command says what to write."""

from __future__ import annotations

import argparse

import pytest

from robbdd_tools.cli import argument_parser
from robbdd_tools.commands.replaced_options import REPLACED, allow_replaced
from robbdd_tools.commands.shell_completion import arguments_of


@pytest.fixture
def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser("tool")
    inner = made.add_subparsers().add_parser("study").add_subparsers().add_parser("run")
    inner.add_argument("--jobs", type=int, default=1)
    inner.add_argument("--keep", action="store_true")
    inner.add_argument("--frame", action="append", choices=("a", "b"))
    allow_replaced(made, {"study run": {"--workers": "--jobs", "--hold": "--keep", "--body": "--frame"}})
    return made


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (["--workers", "3"], ["--jobs", "3"]),
        (["--hold"], ["--keep"]),
        (["--body", "a", "--frame", "b"], ["--frame", "a", "--frame", "b"]),
    ],
)
def test_a_replaced_option_does_what_the_new_one_does_and_names_it(
    old: list[str], new: list[str], parser: argparse.ArgumentParser, capsys: pytest.CaptureFixture[str]
) -> None:
    found = parser.parse_args(["study", "run", *old])
    assert capsys.readouterr().err == f"tool study run: {old[0]} goes in the next version: write {new[0]}\n"
    assert found == parser.parse_args(["study", "run", *new])
    assert capsys.readouterr().err == ""


def test_help_does_not_show_it_and_values_are_checked(
    parser: argparse.ArgumentParser, capsys: pytest.CaptureFixture[str]
) -> None:
    for arguments in (["--help"], ["--body", "c"], ["--workers", "many"]):
        with pytest.raises(SystemExit):
            parser.parse_args(["study", "run", *arguments])
        said = capsys.readouterr()
        assert "--workers" not in said.out
        assert bool(said.err) is (arguments != ["--help"])


def test_each_replaced_option_of_a_command_has_a_new_one() -> None:
    assert arguments_of(argument_parser())
    assert all(
        old.startswith("--") and new.startswith("--") for pairs in REPLACED.values() for old, new in pairs.items()
    )
