"""Fuzzing of what reads graphs, queries and templates."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from random import Random

from tests.nightly.commands import robbdd
from tests.nightly.fuzz import Files, Target
from tests.nightly.mutate import damaged_bytes, damaged_text, encoded

from kit import EXAMPLES, MODEL, ROOT, SCENE
from robbdd_tools.base.data import data_folder
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project

SOURCES = (EXAMPLES / "pickplace" / "pickplace.bdd", EXAMPLES / "tworobots" / "heights.bdd")
QUERY_PARTS = (
    "SERVICE <http://127.0.0.1:9/sparql> { ?s ?p ?o }",
    "FROM <http://127.0.0.1:9/graph>",
    "FILTER(REGEX(?x, '(a+)+$'))",
    "BIND(1/0 AS ?x) OPTIONAL { ?x ?y ?z }",
    "GROUP BY ?x HAVING (COUNT(*) > 1)",
    "{ SELECT * WHERE { ?s ?p ?o } LIMIT 3 }",
    "CONSTRUCT { ?s ?p ?o } WHERE { ?s ?p ?o }",
    "ASK { ?s ?p ?o }",
    "DESCRIBE <urn:x>",
)
TEMPLATE_PARTS = (
    "{{ ''.__class__.__mro__ }}",
    "{{ self.__init__.__globals__ }}",
    "{% include '/etc/passwd' %}",
    "{% import 'os' as os %}",
    "{{ 1 / 0 }}",
    "{{ missing.part.of.it }}",
    "{% for x in range(10) %}{{ loop.index }}{% endfor %}",
    "{{ 'a' * 1000 }}",
    "{% raw %}",
    "{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}",
)
_UNNAMED = re.compile(r"_:\w+|<[^<>]*[#/][^<>#/]*\.[^<>#/]*>")


@cache
def _graphs() -> tuple[tuple[str, str], ...]:
    """Return the graphs of models as text, each with the ending of its file."""
    found: list[tuple[str, str]] = []
    for path in SOURCES:
        project, uri = Project(), path_to_uri(path)
        project.load(uri)
        graph = build_graph(project.snapshot(), uri).graph
        found += [(serialize(graph, format), ending) for format, ending in (("ttl", "ttl"), ("json-ld", "json"))]
    return tuple(found)


def _damaged_graph(random: Random) -> Files:
    text, ending = random.choice(_graphs())
    match random.randrange(4):
        case 0:
            data = damaged_bytes(random, encoded(text))
        case 1:
            data = encoded(damaged_text(random, text, [text]))
        case _:
            data = encoded(_rewired(random, text))
    return {f"case.{ending}": data}


def _rewired(random: Random, text: str) -> str:
    """Return the text with whole lines removed, repeated or swapped: graphs that still can be read."""
    lines = text.split("\n")
    for _ in range(random.randrange(1, 6)):
        one, other = random.randrange(len(lines)), random.randrange(len(lines))
        match random.randrange(4):
            case 0:
                del lines[one]
            case 1:
                lines.insert(one, lines[other])
            case 2:
                lines[one], lines[other] = lines[other], lines[one]
            case _:
                words = lines[one].split(" ")
                words[random.randrange(len(words))] = random.choice(lines[other].split(" "))
                lines[one] = " ".join(words)
    return "\n".join(lines)


def _check_importer(folder: Path) -> None:
    """A graph is imported as valid text of the same graph, with losses reported, or refused with a message."""
    path = next(folder.glob("case.*"))
    done = robbdd(folder, "import", path.name, "-o", "out.bdd")
    if done.code:
        assert not (folder / "out.bdd").exists(), "a refused import leaves a file"
        return
    assert done.output.split(), "an import says nothing of its files"
    outputs = [name for name in ("out.bdd", "out.scene") if (folder / name).exists()]
    for name in outputs:
        checked = robbdd(folder, "check", name)
        assert checked.code == 0, f"imported text has errors:\n{checked.output}"
    if done.errors or "out.bdd" not in outputs:
        return
    before, after = (robbdd(folder, "graph", "--format", "nt", name).output for name in (path.name, "out.bdd"))
    lost = set(_statements(before)) - set(_statements(after))
    assert not lost, f"an import loses in silence: {sorted(lost)[:5]}"


def _statements(triples: str) -> list[str]:
    """Return triples with one name for all generated nodes: blank ones, and those with a dot."""
    return [_UNNAMED.sub("_", line) for line in triples.split("\n")]


def _damaged_query(random: Random) -> Files:
    queries = [path.read_text(encoding="utf-8") for path in sorted(data_folder("metamodels", "queries").glob("*.rq"))]
    text = random.choice(queries)
    if random.random() < 0.3:
        text = text.replace("{", "{ " + random.choice(QUERY_PARTS), 1)
    query = encoded(damaged_text(random, text, [*queries, *QUERY_PARTS]))
    return {"main.bdd": encoded(MODEL), "lab.scene": encoded(SCENE), "query.rq": query}


def _check_query(folder: Path) -> None:
    """A query is answered, or refused with its place."""
    for form in ("table", "csv", "json"):
        done = robbdd(folder, "query", "main.bdd", "-f", "query.rq", "--format", form)
        assert done.code in (0, 2)


def _damaged_template(random: Random) -> Files:
    folder = ROOT / "server" / "robbdd_tools" / "gherkin" / "templates"
    templates = [path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.jinja"))]
    text = damaged_text(random, random.choice(templates), [*templates, *TEMPLATE_PARTS])
    if random.random() < 0.4:
        lines = text.split("\n")
        lines.insert(random.randrange(len(lines) + 1), random.choice(TEMPLATE_PARTS))
        text = "\n".join(lines)
    return {"main.bdd": encoded(MODEL), "lab.scene": encoded(SCENE), "mine.feature.jinja": encoded(text)}


def _check_template(folder: Path) -> None:
    """A template gives features, or is refused with its line; it reads no file."""
    done = robbdd(folder, "gherkin", "main.bdd", "-o", "out", "--template", "mine.feature.jinja")
    assert done.code in (0, 2)
    written = [path.read_text(encoding="utf-8", errors="replace") for path in folder.glob("out/*.feature")]
    assert not any("root:" in text for text in written), "a template reads a file of the system"


GRAPH_TARGETS = (
    Target("importer", _damaged_graph, _check_importer),
    Target("query", _damaged_query, _check_query),
    Target("template", _damaged_template, _check_template),
)
