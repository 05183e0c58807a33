"""Code, messages and pages are plain technical English: words of the former private dialect are banned."""

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
    r"[Tt]ells? (whether|of|for|which|what|apart|them|who)": "Return whether …, determines, identifies",
    r'"""(What|Which|Whose|Whoever)': "the noun: Contents of …, Kinds of …, Input of …",
    r"what stands": "the text at …, the contents of …",
    r"comes? along": "is built-in, is provided by",
    r"passe[sd]? over": "skip, ignore",
    r"in the place of": "instead of",
    r"as it is written": "as written",
    r"leads? nowhere": "is unresolved",
    r"cannot be had|to be had": "is not available",
    r"in vain": "without result",
    r"yes-or-no": "Boolean",
    r"see to it": "ensure",
    r"behind one another": "one after another, row by row",
    r"[Ll]east and (the )?largest": "smallest and largest",
    r"to be filled in": "stub, placeholder",
    r"like names": "similar names",
    r"(of|for|in) which no": "without",
    r"that which": "the noun",
    r"(goes|go|going|went) on with": "continue, resume",
    r"went through": "succeeded, completed",
    r"gave way": "yielded",
    r"(comes?|came|coming) to (its|their) end": "end, finish",
    r"at hand": "current",
    r"lies there": "is at the place, exists",
    r"takes? hold|lets? go": "grip, release",
    r"as they come": "on arrival, in order of arrival",
    r"decides everything": "is the seed of, determines",
    r"has the say": "takes precedence",
    r"there already": "existing, already defined",
    r"moving pictures?": "video",
    r"beside (the|a|its|their|it|them|each|every) (model|file|trace|text|clause)s?": "in the folder of, next to",
    r"in the words of": "as …, in the form of",
    r"looks? anew|judged anew|asked anew": "again",
    r"whosoever|whatsoever": "any",
    r"by whose|of whom": "name the noun",
    r"put down to": "attributed to",
    r"whatever (comes|stands|happens)": "in any case",
    r"Take in": "Read, add, update with",
    r"Say (what|that|which|why|whether|how)": "Report, describe, return",
    r"what is said|what (it|they) (says?|tells?|holds?)": "the noun: the contents, the value, the text",
    r"wrong way round": "reversed",
    r"[Ss]hall": "must, has to",
    r"speaks? of": "mentions, refers to, uses",
    r"nobody has": "no one has, un…ed",
    r"comes? back": "is returned, reappears",
    r"put together": "assembled, combined",
    r"[Ww]hoever": "anyone who, the client that",
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
