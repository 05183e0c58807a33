"""SPARQL over a graph: all prefixes are declared, nothing is fetched, rows come in a fixed order."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.data import data_file, data_folder
from robbdd_tools.graph.canonical import sort_text
from robbdd_tools.graph.prefixes import bind_prefixes, user_prefixes
from robbdd_tools.graph.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

FOLDER = "queries"
_MORE_PREFIXES = {
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "owl": "http://www.w3.org/2002/07/owl#",
    "sh": "http://www.w3.org/ns/shacl#",
}


class BadQuery(Exception):
    """A query cannot be answered; ``offset`` is the place in its text where it goes wrong."""

    def __init__(self, message: str, offset: int = 0) -> None:
        super().__init__(message)
        self.offset = offset


@dataclass(frozen=True, slots=True)
class Term:
    """A node of a graph as plain data: ``kind`` is ``uri``, ``bnode`` or ``literal``."""

    kind: str
    value: str
    datatype: str = ""
    language: str = ""


@dataclass(frozen=True, slots=True)
class Rows:
    """The answer to SELECT: one term or ``None`` per column; to ASK: one cell of the column ``answer``.

    CONSTRUCT and DESCRIBE answer with the triples of a graph: subject, predicate, object. ``prefixes`` maps prefixes
    to namespaces, for whoever shows names.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Term | None, ...], ...]
    prefixes: dict[str, str]


def run_query(graph: Graph, text: str) -> Rows:
    """Answer a query; raises ``BadQuery``. Rows are sorted unless the query orders them itself."""
    from rdflib import Graph

    prefixes = bind_prefixes(Graph(bind_namespaces="none"), user_prefixes(graph))
    known = {**_MORE_PREFIXES, **prefixes}
    query = _prepared(text, known)
    try:
        # rdflib's results are only loosely typed.
        result = cast(Any, graph.query(query))
        if result.type == "ASK":
            truth = Term("literal", str(bool(result.askAnswer)).lower(), expand("xsd:boolean"))
            return Rows(("answer",), ((truth,),), known)
        is_select = result.type == "SELECT"
        rows = cast("list[tuple[Node | None, ...]]", list(result if is_select else result.graph))
    except Exception as error:  # evaluation raises whatever a function of the query runs into
        raise BadQuery(f"the query cannot be answered: {error}") from error
    if not any(part.name == "OrderBy" for part in _parts(query.algebra)):
        rows = sorted(rows, key=_row_order)
    columns = tuple(str(name) for name in result.vars) if is_select else ("subject", "predicate", "object")
    return Rows(columns, tuple(tuple(map(_term, row)) for row in rows), known)


def ready_queries() -> dict[str, str]:
    """Return the names of the queries that come with us and what each tells."""
    paths = sorted(data_folder("metamodels", FOLDER).glob("*.rq"))
    return {path.stem: path.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ") for path in paths}


def ready_query(name: str) -> str | None:
    """Return the text of a query that comes with us, ``None`` when there is none of this name."""
    if name not in ready_queries():
        return None
    return data_file("metamodels", f"{FOLDER}/{name}.rq").read_text(encoding="utf-8")


def _prepared(text: str, prefixes: dict[str, str]) -> Any:
    from pyparsing import ParseBaseException
    from rdflib.plugins.sparql import prepareQuery

    try:
        query = cast(Any, prepareQuery(text, initNs=prefixes))
    except ParseBaseException as error:
        raise BadQuery("the query cannot be read from here on", error.loc) from error
    except Exception as error:  # rdflib raises a bare Exception for an unknown prefix
        unknown = re.search(r"Unknown namespace prefix : (\S*)", str(error))
        found = re.search(rf"(?<![\w.\-]){re.escape(unknown[1])}:", text) if unknown else None
        message = (
            f"the prefix '{unknown[1]}' is not declared; there are {', '.join(prefixes)}" if unknown else str(error)
        )
        raise BadQuery(message, found.start() if found else 0) from error
    if query.algebra.get("datasetClause") or any(part.name == "ServiceGraphPattern" for part in _parts(query.algebra)):
        word = re.search(r"\b(SERVICE|FROM)\b", text, re.IGNORECASE)
        raise BadQuery("a query asks this model only: SERVICE and FROM are not followed", word.start() if word else 0)
    return query


def _parts(algebra: Any) -> Iterator[Any]:
    """Yield all operators of a query."""
    waiting: list[Any] = [algebra]
    while waiting:
        part = waiting.pop()
        if isinstance(part, dict):
            fields = cast("dict[str, Any]", part)
            if hasattr(fields, "name"):
                yield fields
            waiting += fields.values()
        elif isinstance(part, list | tuple):
            waiting += cast("list[Any]", part)


def _term(node: Node | None) -> Term | None:
    from rdflib import BNode, Literal

    if node is None or not isinstance(node, Literal):
        return None if node is None else Term("bnode" if isinstance(node, BNode) else "uri", str(node))
    return Term("literal", str(node), str(node.datatype or ""), node.language or "")


def _row_order(row: tuple[Node | None, ...]) -> tuple[tuple[str, str, str], ...]:
    return tuple(("", "", "") if node is None else sort_text(node) for node in row)
