"""The documentation site: every page is in it, every link stays in it, and nothing is loaded from a network."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote, urldefrag
from xml.etree import ElementTree

import pytest
from pages import SECTIONS

from kit import DOCS, ROOT

LOADED = re.compile(r"<(?:script|img|link)\b[^>]*?\b(?:src|href)=\"(https?:[^\"]+)\"")
LINKED = re.compile(r"<a\b[^>]*?\bhref=\"([^\":]*)\"")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site as ``make docs`` does."""
    pages, site = tmp_path_factory.mktemp("docs") / "pages", tmp_path_factory.mktemp("site")
    subprocess.run([sys.executable, DOCS / "site" / "pages.py", pages], check=True)
    build = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", DOCS / "site", pages, site]
    done = subprocess.run(build, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return site


def test_each_page_is_in_the_site_and_in_the_search(site: Path) -> None:
    pages = {path.relative_to(DOCS).with_suffix("").as_posix() for path in DOCS.rglob("*.md")}
    index = (site / "searchindex.js").read_text(encoding="utf-8")
    missing = [page for page in pages if not (site / f"{page}.html").exists() or f'"{page}"' not in index]
    assert missing == []


def test_each_link_leads_to_a_page_of_the_site_and_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    pages = {path: path.read_text(encoding="utf-8") for path in site.rglob("*.html")}
    assert len(pages) > 100
    for path, text in pages.items():
        assert LOADED.findall(text) == [], path.name
        for link in LINKED.findall(text):
            target, anchor = urldefrag(unquote(link))
            found = (path.parent / target).resolve() if target else path
            assert found.is_file(), (path.name, link)
            assert not anchor or found not in pages or f'id="{anchor}"' in pages[found], (path.name, link)


def test_each_example_has_a_page_with_its_picture(site: Path) -> None:
    examples = {path.parent.name for path in (ROOT / "examples").glob("*/*.bdd")}
    pictures = {path.stem for path in (DOCS / "images" / "examples").glob("*.png")}
    assert pictures == examples, "run .venv/bin/python docs/site/example_pictures.py"
    for name in examples:
        text = (site / "examples" / f"{name}.html").read_text(encoding="utf-8")
        assert f"{name}.png" in text


def test_the_page_of_the_command_line_is_that_of_the_program() -> None:
    program = [sys.executable, "-c", "import command_line; print(command_line.page(), end='')"]
    printed = subprocess.run(program, cwd=DOCS / "site", capture_output=True, text=True, check=True).stdout
    page = (DOCS / "command-line.md").read_text(encoding="utf-8")
    assert page == printed, "run .venv/bin/python docs/site/command_line.py"


def test_the_page_of_the_grammar_is_that_of_the_grammars() -> None:
    program = [sys.executable, "-c", "import language; print(language.page(), end='')"]
    printed = subprocess.run(program, cwd=DOCS / "site", capture_output=True, text=True, check=True).stdout
    page = (DOCS / "language" / "grammar.md").read_text(encoding="utf-8")
    assert page == printed, "run .venv/bin/python docs/site/language.py"
    rows = {line.split("`")[1] for line in page.splitlines() if line.startswith("| `")}
    assert {"const", "permutations", "comp", "kgraph", "exists"} <= rows


def test_the_reference_of_the_language_is_that_of_the_grammars_and_the_examples() -> None:
    program = "import json, reference; print(json.dumps({str(path): text for path, text in reference.files().items()}))"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=DOCS / "site", capture_output=True, text=True, check=True
    )
    made: dict[str, str] = json.loads(done.stdout)
    kept = {path: Path(path).read_text(encoding="utf-8") for path in made if Path(path).is_file()}
    assert kept == made, "run .venv/bin/python docs/site/reference.py"
    diagrams = {path for path in made if path.endswith(".svg")}
    assert {str(path) for path in (DOCS / "language" / "diagrams").iterdir()} == diagrams
    for path in diagrams:
        assert ElementTree.fromstring(made[path]).tag.endswith("svg")


def test_the_page_of_time_shows_what_the_monitor_decides() -> None:
    program = "import json, time_page; found = {}; print(json.dumps([time_page.page(found), found]))"
    printed = subprocess.run(
        [sys.executable, "-c", program], cwd=DOCS / "site", capture_output=True, text=True, check=True
    ).stdout
    page, pictures = json.loads(printed)
    assert (DOCS / "time.md").read_text(encoding="utf-8") == page, "run .venv/bin/python docs/site/time_page.py"
    kept = {path.name: path.read_text(encoding="utf-8") for path in (DOCS / "images" / "time").iterdir()}
    assert kept == pictures


def test_the_drawing_of_the_packages_shows_the_layers_that_are_enforced() -> None:
    program = "import rooms_drawing as rooms; print(rooms.drawing(*rooms.rows_of_the_rules()), end='')"
    printed = subprocess.run(
        [sys.executable, "-c", program], cwd=DOCS / "site", capture_output=True, text=True, check=True
    ).stdout
    kept = (DOCS / "images" / "rooms.svg").read_text(encoding="utf-8")
    assert kept == printed, "run .venv/bin/python docs/site/rooms_drawing.py"


def test_each_page_has_its_place_in_the_table_of_contents() -> None:
    pages = {path.relative_to(DOCS).with_suffix("").as_posix() for path in DOCS.rglob("*.md")}
    named = {page for page in pages if not page.startswith("diagnostics/")}
    listed = {page for section in SECTIONS.values() for page in section}
    assert sorted(named - listed) == []
    assert (ROOT / "Makefile").read_text(encoding="utf-8").count("docs/site/pages.py") == 1
