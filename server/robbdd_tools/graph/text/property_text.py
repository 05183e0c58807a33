"""Write values of properties and conditions on them as RobBDD text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.records import Incomplete, items_of
from robbdd_tools.graph.rdf.vocabulary import QUANTITY, expand
from robbdd_tools.graph.text.names import NAME, Names, quoted

if TYPE_CHECKING:
    from rdflib.term import Node

    from robbdd_tools.graph.rdf.records import Records

SET_BY_PROPERTY = "rbw:SetByProperty"
TRUTHS = ("true", "false")
_NUMERIC = (expand("xsd:integer"), expand("xsd:double"), QUANTITY)


def value_text(names: Names, value: Node) -> str | None:
    """Return a value of a property as text, or ``None`` if the language cannot write it."""
    kind = str(getattr(value, "datatype", None) or "")
    if names.records.iris([value]):
        return f"<{names.paths[str(value)]}>" if str(value) in names.paths else None
    if getattr(value, "language", None):
        return None
    text = str(value)
    if kind == expand("xsd:boolean"):
        return text if text in TRUTHS else None
    if kind in ("", expand("xsd:string")):
        return text if NAME.fullmatch(text) and text not in TRUTHS else quoted(text)
    written = names.value(value) if kind in _NUMERIC else None
    return None if written is None or written.startswith('"') else written


def column_names(records: Records, scene: str) -> dict[str, list[str]]:
    """Return the properties, by set, that the tables of a scene show; without those that the language cannot write."""
    found: dict[str, list[str]] = {}
    for column in map(str, items_of(records, scene, "rbw:table-columns")):
        name = records.text(column, "rbw:property-name")
        for set_ in records.iris(records.all(column, "rbw:of-set")):
            if NAME.fullmatch(name):
                found.setdefault(set_, []).append(name)
    return found


def base_of(names: Names, node: str) -> str:
    """Return the set from which conditions select a set's elements; the set itself if it has no conditions."""
    return names.records.one(node, "rbw:subset-of") if names.records.is_a(node, SET_BY_PROPERTY) else node


def set_reference(names: Names, node: str) -> str:
    """Return the reference to a set with its conditions, ``<parts> where colour = red``. Raises ``Incomplete``."""
    records, base = names.records, base_of(names, node)
    if base == node:
        return names.reference(node)
    conditions: list[str] = []
    for inner in map(str, records.list_of(node, "rbw:where")):
        name, sign = records.text(inner, "rbw:property-name"), records.text(inner, "rbw:comparison")
        values = records.all(inner, "rbw:compared-with")
        value = value_text(names, values[0]) if len(values) == 1 else None
        if value is None or not NAME.fullmatch(name):
            raise Incomplete(f"{node} has a condition that the language cannot write")
        is_flag = value == "true" and sign in ("=", "not")
        conditions.append(f"{'not ' if sign == 'not' else ''}{name}" if is_flag else f"{name} {sign} {value}")
    return f"{names.reference(base)} where {' and '.join(conditions)}"
