"""Writes ``docs/command-line.md`` from the parser of arguments: ``.venv/bin/python docs/site/command_line.py``."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from robbdd_tools.cli import argument_parser
from robbdd_tools.commands.shell_completion import arguments_of, commands_of

PAGE = Path(__file__).parents[1] / "command-line.md"
HEAD = """# Command line

All commands and their arguments, written by `docs/site/command_line.py` from the program itself. `robbdd COMMAND
--help` prints the same; `robbdd completion bash` prints a script that completes them in a shell.

Exit codes: 0 success; 1 errors found (`check`), or a clause violated or unknown (`run`); 2 the command could not do its
work; 128 + *n* ended by signal *n*.
"""
COMMAND = re.compile(r"^    (\w+)\s+(\S.*)", re.MULTILINE)
WIDTH = 1_000
"""Columns of the help, so that no line of it is wrapped."""


def page() -> str:
    """Return the text of the page."""
    return "\n".join([HEAD, *sections("robbdd", argument_parser(), "##")])


def sections(name: str, parser: argparse.ArgumentParser, marks: str) -> Iterator[str]:
    """Yield the lines on the commands of a parser. ``marks`` are those of their headings."""
    commands = {name: command for action in arguments_of(parser) for name, command in commands_of(action).items()}
    parser.formatter_class = partial(argparse.HelpFormatter, width=WIDTH)
    purposes = dict[str, str](COMMAND.findall(parser.format_help()))
    for word, command in sorted(commands.items()):
        purpose = purposes[word]
        yield from (f"{marks} {name} {word}", "", f"{purpose[0].upper()}{purpose[1:]}.", "")
        yield from table(command)
        yield from sections(f"{name} {word}", command, f"{marks}#")


def table(parser: argparse.ArgumentParser) -> Iterator[str]:
    """Yield the lines on the arguments of a command; none if it only chooses among its own commands."""
    shown = [one for one in arguments_of(parser) if one.dest != "help" and one.help != argparse.SUPPRESS]
    if any(map(commands_of, shown)):
        return
    yield from ("| argument | effect |", "|---|---|")
    for action in sorted(shown, key=lambda one: bool(one.option_strings)):
        yield f"| {in_cell(written(action))} | {in_cell((action.help or '').replace('%%', '%'))} |"
    yield ""


def written(action: argparse.Action) -> str:
    """Return an argument as a user writes it."""
    names = action.metavar or "|".join(map(str, action.choices or ())) or action.dest.upper()
    value = names if isinstance(names, str) else " ".join(names)
    value = f"[{value}]" if action.nargs in ("?", "*") else value
    if not action.option_strings:
        return f"`{value}`" + (" …" if action.nargs in ("+", "*") else "")
    return ", ".join(f"`{name}`" if action.nargs == 0 else f"`{name} {value}`" for name in action.option_strings)


def in_cell(text: str) -> str:
    """Return a text as a cell of a table shows it."""
    return text.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
