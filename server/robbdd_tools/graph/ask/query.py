"""Answer SPARQL queries on a graph. All prefixes are declared, nothing is fetched, and rows have a fixed order.

rdflib parses the query and reports its errors. Oxigraph evaluates the query if the extra ``fast-queries`` is installed,
otherwise rdflib does.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from decimal import Decimal
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.data import data_file, data_folder
from robbdd_tools.base.files import load_text
from robbdd_tools.graph.ask.query_prefixes import query_prefixes
from robbdd_tools.graph.ask.vocabularies import operators, patterns, unknown_terms, with_paper_terms
from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

FOLDER = "queries"


class BadQuery(Exception):
    """A query cannot be answered. ``offset`` is the position of the error in the text of the query."""

    def __init__(self, message: str, offset: int = 0) -> None:
        super().__init__(message)
        self.offset = offset


@dataclass(frozen=True, slots=True)
class Term:
    """A node of a graph as plain data.

    ``kind`` is ``uri``, ``bnode`` or ``literal``. A literal that is plain text has no datatype.
    """

    kind: str
    value: str
    datatype: str = ""
    language: str = ""


@dataclass(frozen=True, slots=True)
class Rows:
    """The answer to a query.

    A row of a SELECT has one term or ``None`` for each column. The answer to an ASK is a single cell in the column
    ``answer``. The rows of CONSTRUCT and DESCRIBE are the triples of ``graph``: subject, predicate and object.
    ``prefixes`` maps prefixes to namespaces, for display. ``remarks`` say why the query may have fewer rows than
    expected.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Term | None, ...], ...]
    prefixes: dict[str, str]
    remarks: tuple[str, ...] = ()
    graph: Graph | None = field(default=None, compare=False)


def run_query(graph: Graph, text: str) -> Rows:
    """Answer a query. Rows are sorted, unless the query orders them itself. Raises ``BadQuery``."""
    known, remarks = query_prefixes(graph, text)
    query = _prepared(text, known)
    asked = list(patterns(query.algebra))
    graph = with_paper_terms(graph, asked)
    remarks += unknown_terms(graph, asked, known, text)
    engine = _fast_copy(graph)
    try:
        # rdflib's results are only loosely typed.
        result = cast(Any, graph.query(query) if engine is graph else engine.query(text, initNs=known))
        if result.type == "ASK":
            truth = Term("literal", str(bool(result.askAnswer)).lower(), expand("xsd:boolean"))
            return Rows(("answer",), ((truth,),), known, tuple(remarks))
        is_select = result.type == "SELECT"
        rows = cast("list[tuple[Node | None, ...]]", list(result if is_select else result.graph))
    except Exception as error:  # Evaluation raises any exception of the query's functions.
        raise BadQuery(f"the query cannot be answered: {error}") from error
    terms = [tuple(map(_term, row)) for row in rows]
    if not any(part.name == "OrderBy" for part in operators(query.algebra)):
        terms.sort(key=_row_order)
    columns = tuple(str(name) for name in result.vars) if is_select else ("subject", "predicate", "object")
    return Rows(columns, tuple(terms), known, tuple(remarks), None if is_select else _made(result.graph, known))


def _made(triples: Any, prefixes: dict[str, str]) -> Graph:
    """Return the triples that CONSTRUCT or DESCRIBE made, as a graph with the prefixes of the query."""
    from rdflib import Graph

    found = Graph(bind_namespaces="none")
    found += triples
    for prefix, namespace in prefixes.items():
        found.bind(prefix, namespace, override=True, replace=True)
    return found


def ready_queries() -> dict[str, str]:
    """Return the names and descriptions of the built-in queries."""
    paths = sorted(data_folder("metamodels", FOLDER).glob("*.rq"))
    return {path.stem: load_text(path).partition("\n")[0].lstrip("# ") for path in paths}


def ready_query(name: str) -> str | None:
    """Return the text of the built-in query ``name``, or ``None`` if there is none of this name."""
    if name not in ready_queries():
        return None
    return load_text(data_file("metamodels", f"{FOLDER}/{name}.rq"))


def _fast_copy(graph: Graph) -> Graph:
    """Return a copy of a graph in Oxigraph, or the graph itself if Oxigraph is not installed."""
    from rdflib import Graph

    if find_spec("oxrdflib") is None:
        return graph
    copy = Graph(store="Oxigraph", bind_namespaces="none")
    copy.addN((*triple, copy) for triple in graph)
    return copy


def _prepared(text: str, prefixes: dict[str, str]) -> Any:
    from pyparsing import ParseBaseException
    from rdflib.plugins.sparql import prepareQuery

    try:
        query = cast(Any, prepareQuery(text, initNs=prefixes))
    except ParseBaseException as error:
        raise BadQuery("the query cannot be parsed from here on", error.loc) from error
    except Exception as error:  # rdflib raises a bare Exception for an unknown prefix.
        unknown = re.search(r"Unknown namespace prefix : (\S*)", str(error))
        found = re.search(rf"(?<![\w.\-]){re.escape(unknown[1])}:", text) if unknown else None
        message = (
            f"the prefix '{unknown[1]}' is not declared; there are {', '.join(prefixes)}" if unknown else str(error)
        )
        raise BadQuery(message, found.start() if found else 0) from error
    if query.algebra.get("datasetClause") or any(
        part.name == "ServiceGraphPattern" for part in operators(query.algebra)
    ):
        word = re.search(r"\b(SERVICE|FROM)\b", text, re.IGNORECASE)
        raise BadQuery("a query reads only this model: SERVICE and FROM are not followed", word.start() if word else 0)
    return query


def _term(node: Node | None) -> Term | None:
    from rdflib import XSD, BNode, Literal

    if node is None or not isinstance(node, Literal):
        return None if node is None else Term("bnode" if isinstance(node, BNode) else "uri", str(node))
    datatype = "" if node.datatype == XSD.string else str(node.datatype or "")
    return Term("literal", _lexical(node.value, str(node)), datatype, node.language or "")


def _lexical(value: object, text: str) -> str:
    """Return the canonical form of a number, so that it does not depend on the engine; for example, 1.5 for 1.50.

    Text other than a number is returned unchanged.
    """
    if isinstance(value, Decimal) and value.is_finite():
        return format(value.normalize() if value else Decimal(0), "f")
    return repr(value) if isinstance(value, float) else text


def _row_order(row: tuple[Term | None, ...]) -> tuple[tuple[str, str, str, str], ...]:
    return tuple(
        ("", "", "", "") if term is None else (term.kind, term.value, term.datatype, term.language) for term in row
    )
