"""Settings of Sphinx for the documentation site (``make docs``)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from lexer import GraphLexer, RobbddLexer
from sphinx.application import Sphinx

from robbdd_tools import __version__

project = "RobBDD workbench"
release = __version__
project_copyright = "the authors of RobBDD workbench, Apache-2.0"
extensions = ["myst_parser"]
highlight_language = "none"
exclude_patterns = ["schemas"]
html_extra_path = [str(folder) for folder in (Path(__file__).parents[2] / "build" / "extra",) if folder.is_dir()]
html_search_scorer = str(Path(__file__).parent / "search_order.js")
html_theme = "furo"
html_title = "RobBDD workbench"
html_copy_source = False
html_show_sourcelink = False
myst_heading_anchors = 4
nitpicky = True
man_pages: list[tuple[str, str, str, list[str], int]] = [
    ("command-line", "robbdd", "acceptance tests of robots", [], 1)
]


def setup(app: Sphinx) -> None:
    """Add the colours of the language and of graphs."""
    app.add_lexer("robbdd", RobbddLexer)
    app.add_lexer("turtle", GraphLexer)
