"""What the pages link to is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from kit import DOCS

PAGES = sorted(DOCS.rglob("*.md"))
LINK = re.compile(r"\]\((?!\w+:)([^)#\s]+)(?:#[^)]*)?\)")
A_TEST = re.compile(r"^(?:async )?def test_", re.MULTILINE)
TEST = re.compile(r"\]\((\.\./tests/[^)]+\.py)\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_links_lead_to_files(page: Path) -> None:
    targets = LINK.findall(page.read_text(encoding="utf-8"))
    assert [target for target in targets if not (page.parent / target).exists()] == []


def test_each_feature_that_is_compared_is_linked_to_a_file_of_tests() -> None:
    text = (DOCS / "editors.md").read_text(encoding="utf-8")
    table = [line for line in text[text.index("\n| feature |") :].splitlines() if line.startswith("|")]
    rows = table[2:]
    assert len(rows) > 20
    for row in rows:
        tests = TEST.findall(row)
        assert len(tests) == 1, row
        assert A_TEST.search((DOCS / tests[0]).read_text(encoding="utf-8")) is not None, row
