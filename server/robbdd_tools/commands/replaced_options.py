"""Options that another one replaces: for one version they still work, and the command says what to write."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from typing import Any

from robbdd_tools.commands.output import print_note
from robbdd_tools.commands.shell_completion import arguments_of, commands_of

REPLACED: Mapping[str, Mapping[str, str]] = {}
"""Command, such as ``study run``, to its replaced options, each with the option that replaces it."""


class _Replaced(argparse.Action):
    """Do what the new option does, after a note."""

    def __init__(self, option_strings: list[str], *, by: argparse.Action, named: str, **kept: Any) -> None:
        super().__init__(option_strings, **kept)
        self._by = by
        self._named = named

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        print_note(f"{parser.prog}: {option_string} goes in the next version: write {self._named}")
        self._by(parser, namespace, values, self._named)


def allow_replaced(parser: argparse.ArgumentParser, replaced: Mapping[str, Mapping[str, str]] = REPLACED) -> None:
    """Add the replaced options to the commands of a parser; neither help nor completion shows them."""
    for command, found in _commands("", parser):
        for old, new in replaced.get(command, {}).items():
            (by,) = (one for one in arguments_of(found) if new in one.option_strings)
            same: dict[str, Any] = {"dest": by.dest, "nargs": by.nargs, "type": by.type, "choices": by.choices}
            hidden: dict[str, Any] = {"default": argparse.SUPPRESS, "help": argparse.SUPPRESS}
            found.add_argument(old, action=_Replaced, by=by, named=new, **same, **hidden)


def _commands(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    yield name, parser
    for action in arguments_of(parser):
        for word, command in commands_of(action).items():
            yield from _commands(f"{name} {word}".strip(), command)
