"""Pages of the documentation site: those of the repository, with links that stay within the site, and one per example.

``python docs/site/pages.py FOLDER`` writes them as Markdown for Sphinx; ``make docs`` builds the site from them.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
SECTIONS = {
    "Start": ("tutorial", "overview", "playground"),
    "How to": (
        *(
            "running",
            "simulation",
            "robots",
            "logs",
            "campaigns",
            "cluster",
            "external-systems",
            "comparing",
            "mutate",
            "falsify",
            "continuous-integration",
            "editors",
            "debugging",
        ),
        *(
            "requirements",
            "evidence",
            "gherkin",
            "pytest",
            "python",
            "own-words",
            "assistants/SKILL",
            "assistants/language",
            "troubleshooting",
            "upgrading",
            "changelog",
        ),
    ),
    "Examples": (),
    "Reference": (
        "language/README",
        *(f"language/{page}" for page in ("criteria", "scenes", "executable-scenes", "executions", "all-files")),
        *("language/words", "language/studies", "language/grammar"),
        "command-line",
        "semantics",
        "diagnostics/README",
        "python-reference",
        "protocol",
        "graph",
        "files",
        "limits",
    ),
    "Explanation": ("concepts", "time", "study", "language/design", "peers", "compatibility", "graph-differences"),
    "Project": ("performance", "reliability", "mutants", "ARCHITECTURE", "CONTRIBUTING", "SECURITY"),
}
"""The table of contents; the examples are added from their folders."""
TOP = ("ARCHITECTURE", "CONTRIBUTING", "SECURITY")
"""Pages from the top of the repository."""
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\((?!\w+:)([^)#\s]*)(#[^)\s]*)?\)")
PLAYGROUND = """# Playground

Edit a model and see its problems, its Gherkin and its graph, as text and as a picture. *Replay* shows recorded
executions in three dimensions, with the margins of their clauses over time. Everything runs in this page; nothing is
sent anywhere.
It has to be served: `python -m http.server --directory build/site`.

<iframe src="playground/index.html" title="Playground" style="width: 100%; height: 42rem; border: 1px solid"></iframe>
"""
COMMENT = re.compile(r"(?:^//.*\n)+")
KINDS = (".bdd", ".scene", ".bddx", ".scenex", ".ktree")


def assemble(folder: Path) -> None:
    """Write the pages and the pictures of the site into an empty folder."""
    shutil.copytree(DOCS, folder, ignore=shutil.ignore_patterns("site", "__pycache__"))
    for page in sorted(DOCS.rglob("*.md")):
        place = page.relative_to(DOCS)
        (folder / place).write_text(linked(page, place), encoding="utf-8")
    with (folder / "diagnostics" / "README.md").open("a", encoding="utf-8") as diagnostics:
        diagnostics.write(contents({"Codes": sorted(path.stem for path in (DOCS / "diagnostics").glob("[a-z]*.md"))}))
    for name in TOP:
        (folder / f"{name}.md").write_text(linked(ROOT / f"{name}.md", Path(f"{name}.md")), encoding="utf-8")
    (folder / "examples").mkdir()
    for example in examples():
        (folder / "examples" / f"{example.name}.md").write_text(example_page(example), encoding="utf-8")
    (folder / "playground.md").write_text(PLAYGROUND, encoding="utf-8")
    start = linked(ROOT / "README.md", Path("index.md"))
    (folder / "index.md").write_text(start + contents(sections()), encoding="utf-8")


def examples() -> list[Path]:
    """Return the folders of the examples that have a model."""
    return sorted({path.parent for path in (ROOT / "examples").glob("*/*.bdd")})


def sections() -> dict[str, Sequence[str]]:
    """Return the table of contents with the examples."""
    return {**SECTIONS, "Examples": [f"examples/{example.name}" for example in examples()]}


def contents(titled: Mapping[str, Sequence[str]]) -> str:
    """Return tables of contents as Sphinx reads them."""
    tables = (
        "\n".join(["", "```{toctree}", ":hidden:", f":caption: {title}", "", *pages, "```", ""])
        for title, pages in titled.items()
    )
    return "".join(tables)


def linked(source: Path, place: Path) -> str:
    """Return the text of a page whose links lead to pages of the site; a link to other files becomes plain text."""

    def replace(found: re.Match[str]) -> str:
        image, text, target, anchor = found[1], found[2], found[3], found[4] or ""
        if not target:
            return found[0]
        inside = site_place((source.parent / target).resolve())
        if inside is None:
            return text
        return f"{image}[{text}]({os.path.relpath(inside, place.parent)}{anchor})"

    return LINK.sub(replace, source.read_text(encoding="utf-8"))


def site_place(target: Path) -> Path | None:
    """Return where a file of the repository is in the site; ``None`` if it is not part of it."""
    if target.parent == ROOT / "examples" and target in examples():
        return Path("examples", f"{target.name}.md")
    if target.parent == ROOT and target.stem in TOP:
        return Path(target.name)
    if target == ROOT / "README.md":
        return Path("index.md")
    if target.is_relative_to(DOCS) and target.is_file():
        return target.relative_to(DOCS)
    return None


def example_page(example: Path) -> str:
    """Return the page of an example: its purpose, its picture, how to run it, its files."""
    models = sorted(example.glob("*.bdd"))
    lines = [f"# {example.name}", "", *(text for model in models for text in purpose(model)), ""]
    lines += [f"![The scene of {example.name}](../images/examples/{example.name}.png)", "", "```console"]
    lines += [f"$ robbdd new cell --template {example.name}", "$ robbdd run cell", "```", ""]
    files = sorted(
        (path for path in example.iterdir() if path.suffix in KINDS), key=lambda path: KINDS.index(path.suffix)
    )
    for path in files:
        lines += [f"## {path.name}", "", "```robbdd", path.read_text(encoding="utf-8").rstrip(), "```", ""]
    return "\n".join(lines)


def purpose(model: Path) -> Iterator[str]:
    """Yield the comment at the beginning of a model."""
    found = COMMENT.match(model.read_text(encoding="utf-8"))
    yield from (line.removeprefix("//").strip() for line in found[0].splitlines()) if found else ()


if __name__ == "__main__":
    assemble(Path(sys.argv[1]))
