"""Code, messages and pages are plain technical English: words of a private dialect do not come back."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PLACES = (
    "server",
    "client-vscode/src",
    "client-vscode/webviews",
    "client-vscode/walkthrough",
    "docs",
    "grammar",
    "metamodels",
    "examples",
)
KINDS = (".py", ".ts", ".md", ".tx", ".ttl", ".json", ".jinja")
PLAIN = {
    r"told": "reported, known, read from",
    r"mend(s|ed|ing)?": "fix, repair",
    r"come what may": "in any case",
    r"whosever": "",
    r"looks? at nothing": "ignores",
    r"goes without saying": "",
    r"no path tells": "",
    r"gives way": "yields, is replaced",
    r"STRANGER": "UNKNOWN_…",
    r"_bury|_?Doing": "what the function or the class does",
}
"""Pattern of a word → what to write in its place."""


def pages() -> list[Path]:
    found = (path for place in PLACES for path in (ROOT / place).rglob("*") if path.suffix in KINDS)
    return sorted(path for path in (*ROOT.glob("*.md"), *found) if path.is_file() and "node_modules" not in path.parts)


@pytest.mark.parametrize("word", PLAIN)
def test_nobody_writes_the_dialect(word: str) -> None:
    pattern = re.compile(rf"(?<![\w-])(?:{word})(?![\w-])")
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in pages()
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if pattern.search(line)
    ]
    assert found == [], f"write instead: {PLAIN[word]}"
