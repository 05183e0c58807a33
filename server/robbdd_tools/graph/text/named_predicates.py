"""Write named predicates of a graph, and the phrases that use them, as RobBDD text."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.records import Incomplete, items_of
from robbdd_tools.graph.read.named_predicates import PLACEHOLDER, read_named

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate
    from robbdd_tools.graph.acceptance_model import Iri
    from robbdd_tools.graph.text.names import Names


def named_phrase(names: Names, predicate: Predicate, use: Iri, variable: Callable[[str], str]) -> str:
    """Return the phrase of a named predicate with its values. ``use`` is the node that uses the predicate."""
    values = [
        variable(str(node)) if names.records.iris([node]) else names.value(node)
        for node in items_of(names.records, use, "rbw:argument-list")
    ]
    return _filled(_words(names, predicate.name), values)


def declare_predicate(names: Names, node: Iri) -> None:
    """Declare the name of a named predicate and the names of its parameters. Raises ``Incomplete``."""
    read_named(names.records, node)
    own = names.split(node)[1]
    words = names.records.text(node, "rbw:phrase").split()
    if "-" not in own or words.count(own) != 1:
        raise Incomplete("its phrase does not contain its name, or the name has no hyphen")
    name = names.declare(node, "predicate")
    namespace = names.split(node)[0]
    for parameter in items_of(names.records, node, "rbw:parameters"):
        before = f"parameter-{name}."
        names.declare(str(parameter), "parameter", owner=name, namespace=namespace, before=before)


def predicate_text(names: Names, node: Iri, state: Callable[[Iri, dict[str, str]], str]) -> str:
    """Return the declaration of a named predicate. ``state`` writes its definition with the given parameters.

    Raises ``Incomplete``.
    """
    parameters = [str(one) for one in items_of(names.records, node, "rbw:parameters")]
    own = {one: f"<{names.paths[one].rpartition('.')[2]}>" for one in parameters}
    phrase = _filled(_words(names, node), list(own.values()))
    body = state(names.records.one(node, "rbw:defined-as"), own)
    return f"Predicate {names.scope_of(node)} {phrase}: {body}"


def _words(names: Names, node: str) -> str:
    """Return the phrase of a predicate, with the name that the predicate has in the text."""
    own = names.split(node)[1]
    words = names.records.text(node, "rbw:phrase").split()
    return " ".join(names.paths[node] if word == own else word for word in words)


def _filled(phrase: str, values: list[str]) -> str:
    following = iter(values)
    return PLACEHOLDER.sub(lambda _: next(following), phrase)
