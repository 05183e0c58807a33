"""``robbdd completion``: a script with which a shell completes commands, options and files."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import cast

import shtab

from robbdd_tools.commands import OK
from robbdd_tools.commands.output import print_document


def print_completion(parser: argparse.ArgumentParser, shell: str) -> int:
    """Print the script of a shell, for all commands of a parser."""
    _complete_files(parser)
    print_document(shtab.complete(parser, shell) + "\n")
    return OK


def _complete_files(parser: argparse.ArgumentParser) -> None:
    """Mark the arguments that are files, so that the shell completes them as such."""
    for action in arguments_of(parser):
        for command in commands_of(action).values():
            _complete_files(command)
        if action.type is Path:
            vars(action)["complete"] = shtab.FILE


def arguments_of(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """Return the arguments of a parser."""
    return parser._actions  # pyright: ignore[reportPrivateUsage]  # argparse lists them nowhere else


def commands_of(action: argparse.Action) -> dict[str, argparse.ArgumentParser]:
    """Return the parsers among which an argument chooses, by the names of the commands."""
    choices: object = action.choices
    return cast("dict[str, argparse.ArgumentParser]", choices) if isinstance(choices, dict) else {}
