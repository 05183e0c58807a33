"""Every diagnostic code has a page in the documentation, and every page a code."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import robbdd_tools
from kit import DOCS
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.lsp.convert import code_page

PACKAGE = Path(robbdd_tools.__file__).parent
PAGES = DOCS / "diagnostics"
CODE_ARGUMENT = {"Diagnostic": 3, "Unreadable": 0, "finding": 3, "unused": 2}
"""Makers of findings → position of the code among their arguments."""
FAMILIES = {
    "shacl-": {"shacl"},
    "shape-": {"shape"},
    "clause-": {"clause-violated", "clause-unknown", "clause-undefined"},
}
"""Beginnings of codes that are put together at run time → their pages."""


def emitted() -> Iterator[str]:
    """Yield the codes in the source, those put together at run time by their beginnings."""
    for path in sorted(PACKAGE.rglob("*.py")):
        module = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(module):
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) in ("CODE", "code"):
                yield from _code(node.value)
            elif isinstance(node, ast.Call) and ast.unparse(node.func) in CODE_ARGUMENT:
                named = [keyword.value for keyword in node.keywords if keyword.arg == "code"]
                yield from _code([*node.args, *named][CODE_ARGUMENT[ast.unparse(node.func)]])


def _code(value: ast.expr) -> Iterator[str]:
    if isinstance(value, ast.JoinedStr):
        value = value.values[0]
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        yield value.value


CODES = sorted(set(emitted()))


@pytest.mark.parametrize("code", CODES)
def test_a_code_has_a_page_that_the_index_names(code: str) -> None:
    for name in FAMILIES.get(code, {code}):
        assert (PAGES / f"{name}.md").read_text(encoding="utf-8").startswith(f"# `{name}`\n")
        assert f"[`{name}`]({name}.md)" in (PAGES / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("code", CODES)
def test_a_code_leads_to_its_page(code: str) -> None:
    for name in FAMILIES.get(code, {code}):
        of_a_shape = f"{name}-safety" if code in ("shacl-", "shape-") else name
        assert code_page(of_a_shape) == path_to_uri(PAGES / f"{name}.md")


@pytest.mark.parametrize("page", sorted(PAGES.glob("*.md")), ids=lambda page: page.stem)
def test_a_page_has_a_code(page: Path) -> None:
    known = set(CODES).union(*FAMILIES.values())
    assert page.stem in known or page.stem == "README"


def test_the_codes_are_found_in_the_source() -> None:
    assert {"syntax", "file-missing", "unused-event", "type-conflict", "shacl-", "clause-"} <= set(CODES)
