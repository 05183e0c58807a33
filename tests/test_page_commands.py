"""The commands on the pages exist with their options, and other texts that programs read can be read."""

from __future__ import annotations

import argparse
import json
import re
import shlex
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import cast

import pytest
import yaml
from pages import example_page, examples

from kit import DOCS, ROOT
from robbdd_tools.cli import argument_parser

PAGES = [*sorted(DOCS.rglob("*.md")), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md"))]
BLOCK = re.compile(r"^```(?P<kind>\w*)\n(?P<text>.*?)^```", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"(?<!`)`(robbdd [^`\n]+)`")
OPTION = re.compile(r"(?<![\w\-'\"<./=])(--?[a-z][\w\-]*)")
USAGE = re.compile(r"[\[\]|…{}]|\.\.\.|<")
"""Signs of a usage line, which has alternatives and optional parts."""
READERS: dict[str, Callable[[str], object]] = {
    "json": json.loads,
    "toml": tomllib.loads,
    "yaml": yaml.safe_load,
    "python": lambda text: compile(text, "page", "exec"),
}


def commands(page: Path) -> Iterator[tuple[str, bool]]:
    """Yield the commands of a page, and whether each is a whole line to be typed."""
    text = page.read_text(encoding="utf-8")
    for block in BLOCK.finditer(text):
        for line in re.sub(r"\\\n\s*", " ", block["text"]).splitlines():
            words = line.strip().removeprefix("$ ")
            if re.match(r"robbdd (?!=)", words):
                yield words, True
    for found in INLINE.findall(BLOCK.sub("", text)):
        if not found.startswith("robbdd ="):
            yield found, False


def subcommands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """Return the commands below a parser; there is no public way to ask for them."""
    for action in parser._actions:  # pyright: ignore[reportPrivateUsage]
        choices = cast("object", action.choices)
        if isinstance(choices, dict):
            return cast("dict[str, argparse.ArgumentParser]", choices)
    return {}


def problem(command: str, *, is_line: bool) -> str | None:
    """Return what is wrong with a command."""
    words = re.sub(r"\\(\|)", r"\1", command).split()[1:]
    parser, known = argument_parser(), {"--version", "--help"}
    while words and words[0] in subcommands(parser):
        parser = subcommands(parser)[words.pop(0)]
        known |= set(parser._option_string_actions)  # pyright: ignore[reportPrivateUsage]
    if subcommands(parser) and words and not words[0].startswith("-"):
        several = words[0].split("|")
        return None if all(one in subcommands(parser) for one in several) else f"no command '{words[0]}'"
    rest = re.sub(r"\$\([^)]*\)", "OUTPUT", command.partition(" # ")[0])
    unknown = [option for option in OPTION.findall(rest) if option not in known]
    if unknown:
        return f"no option {', '.join(unknown)}"
    if is_line and not USAGE.search(rest):
        try:
            argument_parser().parse_args(shlex.split(rest, comments=True)[1:])
        except SystemExit:
            return "its arguments are not accepted"
    return None


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_each_command_of_a_page_exists_with_its_options(page: Path) -> None:
    found = {command: problem(command, is_line=is_line) for command, is_line in commands(page)}
    assert {command: what for command, what in found.items() if what is not None} == {}


def test_commands_are_found_and_wrong_ones_noticed() -> None:
    every = [one for page in PAGES for one in commands(page)]
    assert len(every) > 120
    assert sum(is_line for _, is_line in every) > 35
    assert problem("robbdd resume", is_line=False) == "no command 'resume'"
    assert problem("robbdd run cell.bdd --jbos 2", is_line=True) == "no option --jbos"
    assert problem("robbdd run cell.bdd --jobs many", is_line=True) == "its arguments are not accepted"
    assert problem("robbdd study status|show FILE.study [--store DIR]", is_line=True) is None


@pytest.mark.parametrize("example", examples(), ids=lambda example: example.name)
def test_the_page_of_an_example_has_commands_that_exist(example: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(example_page(example), encoding="utf-8")
    found = list(commands(page))
    assert found[0][0] == f"robbdd new cell --template {example.name}"
    assert [problem(command, is_line=is_line) for command, is_line in found] == [None] * len(found)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_texts_that_programs_read_can_be_read(page: Path) -> None:
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        read = READERS.get(block["kind"])
        if read is not None and "…" not in block["text"]:
            read(block["text"])


def test_the_page_of_the_command_line_has_each_command_with_each_of_its_options() -> None:
    page = (DOCS / "command-line.md").read_text(encoding="utf-8")
    parts = dict(re.findall(r"^#{2,} (robbdd .+)\n((?:(?!#).*\n?)*)", page, re.MULTILINE))
    known = dict(all_commands("robbdd", argument_parser()))
    assert list(parts) == sorted(known)
    assert {"robbdd study resume", "robbdd evidence verify"} <= set(known)
    for name, parser in known.items():
        if not subcommands(parser):
            usage = re.sub(r"\s+", " ", parser.format_usage())
            wanted = set(OPTION.findall(usage)) - {"-h"}
            assert wanted <= set(OPTION.findall(parts[name].replace("`", " "))), name


def all_commands(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """Yield the commands below a parser, at any depth, with their names."""
    for word, command in subcommands(parser).items():
        yield f"{name} {word}", command
        yield from all_commands(f"{name} {word}", command)
