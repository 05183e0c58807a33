"""The language core as the playground uses it: texts in, JSON out. Places are those of JavaScript, in UTF-16 units."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable
from typing import Any

if sys.platform == "emscripten":
    os.environ["RAPIDFUZZ_IMPLEMENTATION"] = "python"  # its compiled form does not run in a browser

from robbdd_tools.base.data import data_folder
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.document import Span
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.hover import hover
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.names.project import Project, Snapshot

FOLDER = "file:///playground/"
SUFFIXES = (".bdd", ".scene")


class Text:
    """A text whose places are counted in code points here and in UTF-16 units by JavaScript."""

    def __init__(self, text: str) -> None:
        self.text = text

    def units(self, place: int) -> int:
        """Return a place as JavaScript counts it."""
        return place if self.text.isascii() else len(self.text[:place].encode("utf-16-le")) // 2

    def points(self, place: int) -> int:
        """Return a place of JavaScript as Python counts it."""
        if self.text.isascii():
            return place
        return len(self.text.encode("utf-16-le")[: 2 * place].decode("utf-16-le", "ignore"))

    def range(self, span: Span) -> list[int]:
        """Return a range as JavaScript counts it."""
        return [self.units(span.start), self.units(span.end)]


class Playground:
    """The open files, and what is known of them."""

    def __init__(self) -> None:
        self._project = Project()
        self._texts: dict[str, Text] = {}
        self._version = 0

    def examples(self) -> list[str]:
        """Return the names of the examples."""
        folder = data_folder("", "examples")
        return sorted({path.parent.name for path in folder.glob("*/*.bdd")})

    def open(self, example: str) -> dict[str, str]:
        """Replace all files by those of an example, and return their texts by their names."""
        for name in list(self._texts):
            self._project.close(FOLDER + name)
        self._texts.clear()
        folder = data_folder("", "examples") / example
        paths = (path for suffix in SUFFIXES for path in sorted(folder.glob(f"*{suffix}")))
        files = {path.name: path.read_text(encoding="utf-8") for path in paths}
        for name, text in files.items():
            self.change(name, text)
        return files

    def change(self, name: str, text: str) -> None:
        """Take the text of a file."""
        self._version += 1
        self._texts[name] = Text(text)
        self._project.open(FOLDER + name, self._version, text)

    def check(self, name: str) -> dict[str, Any]:
        """Return the findings of syntax, names and rules, and the concept of each word."""
        snapshot, text = self._now(), self._texts[name]
        words = [[*text.range(one.span), one.concept] for one in semantic_tokens(snapshot, FOLDER + name)]
        return {"findings": self._findings(name, fast_diagnostics(snapshot, FOLDER + name)), "words": words}

    def validate(self, name: str) -> list[dict[str, Any]]:
        """Return the findings of SHACL."""
        from robbdd_tools.graph.shapes.validate import validate
        from robbdd_tools.graph.write.build import build_graph

        return self._findings(name, validate(build_graph(self._now(), FOLDER + name)))

    def hover(self, name: str, place: int) -> dict[str, Any] | None:
        """Return the description of what is at a place, as Markdown."""
        text = self._texts[name]
        found = hover(self._now(), FOLDER + name, text.points(place))
        return None if found is None else {"markdown": found.markdown, "range": text.range(found.span)}

    def complete(self, name: str, place: int) -> list[dict[str, Any]]:
        """Return what may stand at a place, the best first."""
        text = self._texts[name]
        found = complete(self._now(), FOLDER + name, text.points(place))
        return [
            {"label": one.label, "detail": one.detail, "text": one.text, "range": text.range(one.span)}
            for one in sorted(found, key=lambda one: (one.rank, one.label))
            if one.kind != "snippet"
        ]

    def feature(self, name: str) -> str:
        """Return the Gherkin of a file without errors."""
        from robbdd_tools.gherkin.preview import preview

        return preview(self._now(), FOLDER + name).text

    def graph(self, name: str) -> str:
        """Return the knowledge graph of a file as Turtle."""
        from robbdd_tools.graph.rdf.serialize import serialize
        from robbdd_tools.graph.write.build import build_graph

        return serialize(build_graph(self._now(), FOLDER + name).graph, "ttl")

    def picture(self, name: str) -> str:
        """Return a picture of the knowledge graph of a file as SVG."""
        from robbdd_tools.features.graph_picture import graph_picture

        return graph_picture(self._now(), FOLDER + name).svg

    def _now(self) -> Snapshot:
        return self._project.snapshot()

    def _findings(self, name: str, found: Iterable[Diagnostic]) -> list[dict[str, Any]]:
        text = self._texts[name]
        return [
            {
                "range": text.range(one.span),
                "severity": one.severity.name.lower(),
                "code": one.code,
                "message": one.message,
                "fixes": [
                    {"title": fix.title, "edits": [[*text.range(edit.span), edit.text] for edit in fix.edits]}
                    for fix in one.fixes
                    if fix.new_file is None and all(edit.uri == FOLDER + name for edit in fix.edits)
                ],
            }
            for one in found
            if one.uri == FOLDER + name
        ]


def serve(playground: Playground) -> Callable[[str, str], str]:
    """Return a function that calls a method with arguments in JSON, and returns its answer in JSON."""

    def call(method: str, arguments: str) -> str:
        return json.dumps(getattr(playground, method)(*json.loads(arguments)))

    return call
