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
    parser = argument_parser()
    commands = {name: command for action in arguments_of(parser) for name, command in commands_of(action).items()}
    parser.formatter_class = partial(argparse.HelpFormatter, width=WIDTH)
    purposes = dict[str, str](COMMAND.findall(parser.format_help()))
    sections = (section(name, purposes[name], commands[name]) for name in sorted(commands))
    return "\n".join([HEAD, *(line for lines in sections for line in lines)])


def section(name: str, purpose: str, parser: argparse.ArgumentParser) -> Iterator[str]:
    """Yield the lines on a command."""
    yield from (f"## robbdd {name}", "", f"{purpose[0].upper()}{purpose[1:]}.", "")
    yield from ("| argument | effect |", "|---|---|")
    for action in arguments_of(parser):
        if action.dest != "help" and action.help != argparse.SUPPRESS:
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
