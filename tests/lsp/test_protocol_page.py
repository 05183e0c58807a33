"""The page on the protocol names every method, command and initialization option of the server, and every schema."""

from __future__ import annotations

import ast
import inspect
import re

import pytest

from kit import DOCS
from robbdd_tools.lsp import handlers
from robbdd_tools.lsp.handlers import create_server

PAGE = (DOCS / "protocol.md").read_text(encoding="utf-8")
NAMED = set(re.findall(r"`((?:\w+/)+\w+|robbdd\.\w+)`", PAGE))
OF_EVERY_SERVER = {"initialize", "initialized", "shutdown"}
IF_THE_CLIENT_PULLS = {"textDocument/diagnostic", "workspace/diagnostic"}
SENT = {
    "textDocument/publishDiagnostics",
    "workspace/diagnostic/refresh",
    "robbdd/runMessage",
}
OF_THE_PROTOCOL = {"workspace/executeCommand"}
OF_THE_CLIENT = re.compile(r"robbdd\.(show|debug|runStudy|resumeStudy|shapes|rejudge)\w*")
SCHEMAS = sorted(path.name for path in (DOCS / "schemas").glob("*.json"))


def registered(kind: str) -> dict[str, object]:
    """Return the handlers that a server has registered by their names; pygls gives them no complete types."""
    return getattr(create_server().protocol.fm, kind)


def test_it_names_each_method_of_the_server_and_no_other() -> None:
    answered = set(registered("features")) - OF_EVERY_SERVER
    methods = {name for name in NAMED if "/" in name}
    assert methods == answered | IF_THE_CLIENT_PULLS | SENT | OF_THE_PROTOCOL


def test_it_names_each_command_of_the_server_and_no_other() -> None:
    commands = {name for name in NAMED if "/" not in name and not OF_THE_CLIENT.fullmatch(name)}
    assert commands == set(registered("commands"))


def test_it_names_each_initialization_option_that_the_server_reads() -> None:
    calls = (node for node in ast.walk(ast.parse(inspect.getsource(handlers))) if isinstance(node, ast.Call))
    read = {ast.literal_eval(call.args[0]) for call in calls if ast.unparse(call.func) == "able.get"}
    table = PAGE.partition("## Standard methods")[0]
    assert set(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == read


@pytest.mark.parametrize("name", [name for name in SCHEMAS if "robbdd/" in (DOCS / "schemas" / name).read_text()])
def test_it_links_the_schema_of_each_answer(name: str) -> None:
    assert f"](schemas/{name})" in PAGE
