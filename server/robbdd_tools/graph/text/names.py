"""Names for the nodes of a graph in RobBDD text: namespaces, unused names and references."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import is_quantity
from robbdd_tools.graph.rdf.prefixes import prefix_for
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.rdf.vocabulary import QUANTITY, expand

if TYPE_CHECKING:
    from rdflib.term import Node

NAME = re.compile(r"[^\W\d][\w\-]*")
_ENDING = re.compile(r"[^\W\d][\w\-]*\Z")
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?")
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}
_VARIABLES = frozenset({"variable", "each"})
"""Kinds that may share a node: variables of templates, and variables of quantifiers in other templates."""
NO_NAMESPACE = "https://robbdd.org/imported/"
"""Namespace for nodes without a writable name."""


@dataclass(slots=True)
class Names:
    """Assigns a name to each node once.

    ``renamed`` maps nodes to their new IRIs in the text. ``stated`` maps namespaces to the prefixes of the graph, and
    ``used`` maps them to the prefixes that the text needs.
    """

    records: Records
    stated: Mapping[str, str]
    used: dict[str, str] = field(default_factory=dict[str, str])
    paths: dict[str, str] = field(default_factory=dict[str, str])
    renamed: dict[str, str] = field(default_factory=dict[str, str])
    declared: dict[str, dict[str, None]] = field(default_factory=dict[str, dict[str, None]])
    _taken: dict[str, set[str]] = field(default_factory=dict[str, set[str]])
    _iris: set[str] = field(default_factory=set[str])
    _kinds: dict[str, str] = field(default_factory=dict[str, str])

    def split(self, node: str) -> tuple[str, str]:
        """Return the namespace and the name of a node.

        The name is ``""`` if the node has no name that can be written.
        """
        fitting = [ns for ns in self.stated if node.startswith(ns) and NAME.fullmatch(node[len(ns) :])]
        if fitting:
            longest = max(fitting, key=len)
            return longest, node[len(longest) :]
        cut = max(node.rfind(sign) for sign in "/#:") + 1
        match = _ENDING.search(node, cut) if cut else None
        return (node[: match.start()], match[0]) if match else (NO_NAMESPACE, "")

    def declare(self, node: str, kind: str, *, owner: str = "", namespace: str | None = None, before: str = "") -> str:
        """Return the name of a node for its declaration, and record the reference to it.

        - ``kind``: the kind of the declaration. It is also the name if the node has none.
        - ``owner``: the qualified name of the node's parent.
        - ``namespace``: the namespace that the text imposes on the node.
        - ``before``: the text that the language puts before the name in the IRI.

        Raises ``Incomplete`` if the node is already declared as something else.
        """
        first = self._kinds.setdefault(node, kind)
        if first != kind and not {first, kind} <= _VARIABLES:
            raise Incomplete(f"{node} is already written as {first}, so it cannot be {kind} as well")
        own, name = self.split(node)
        if namespace is not None and node.startswith(namespace + before):
            local = node[len(namespace + before) :]
            name = local if NAME.fullmatch(local) else name
        name = name.removeprefix(before) if before and NAME.fullmatch(name.removeprefix(before)) else name
        space = own if namespace is None else namespace
        name = self._free(name or kind, owner, space + before, node)
        iri = f"{space}{before}{name}"
        self._iris.add(iri)
        if iri != node:
            self.renamed[node] = iri
        self.paths[node] = f"{owner}.{name}" if owner else name
        return name

    def fresh(self, name: str) -> str:
        """Return a name that no declaration at the top level of the file uses yet."""
        return self._free(name, "", "", "")

    def prefix(self, namespace: str) -> str:
        """Return the prefix of a namespace, and declare the prefix in the text."""
        if namespace not in self.used:
            wanted = self.stated.get(namespace) or re.split(r"[/#:]", namespace.rstrip("/#:"))[-1]
            others = {prefix for ns, prefix in self.stated.items() if ns != namespace}
            self.used[namespace] = prefix_for(wanted, {*self.used.values(), *others})
        return self.used[namespace]

    def scope_of(self, node: str) -> str:
        """Return ``(ns=prefix)`` with the prefix of the node's namespace."""
        return f"(ns={self.prefix(self.split(node)[0])})"

    def reference(self, node: str) -> str:
        """Return the reference ``<name>``. Raises ``Incomplete`` if the text does not declare the node."""
        if node not in self.paths:
            raise Incomplete(f"{node} is not declared")
        return f"<{self.paths[node]}>"

    def lazily(self, node: str, kind: str) -> str:
        """Return the reference ``<name>`` to an event or a task, and declare it if necessary."""
        if node not in self.paths:
            self.declared.setdefault(kind, {})[node] = None
            self.declare(node, kind)
        return f"<{self.paths[node]}>"

    def value(self, node: Node) -> str:
        """Return an element or a literal as a value. Raises ``Incomplete`` for any other node."""
        literal = self.records.value(node)
        if not self.records.iris([node]):
            text, kind = str(node), str(getattr(node, "datatype", None) or "")
            if kind == expand("xsd:integer") and _NUMBER.fullmatch(text):
                return text
            if isinstance(literal, float) and _NUMBER.fullmatch(text):
                return f"{text}.0" if text.lstrip("+-").isdigit() else text
            return text if kind == QUANTITY and is_quantity(text) else quoted(text)
        return self.reference(str(node))

    def _free(self, name: str, owner: str, before: str, node: str) -> str:
        taken = self._taken.setdefault(owner, set())
        number = 1
        free = name
        while free in taken or (before and before + free != node and before + free in self._iris):
            number += 1
            free = f"{name}-{number}"
        taken.add(free)
        return free


def quoted(text: str) -> str:
    """Return a string literal of the language."""
    return '"' + "".join(_ESCAPES.get(sign, sign) for sign in text) + '"'


def braces(parts: Iterable[str]) -> str:
    """Return a list in braces."""
    inner = ", ".join(parts)
    return f"{{ {inner} }}" if inner else "{ }"


def indented(text: str) -> str:
    """Return text that is indented by one level. Strings in it contain no line breaks."""
    return "\n".join(f"    {line}" if line else line for line in text.split("\n"))
