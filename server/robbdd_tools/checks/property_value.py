"""``property-value``: a property is stated twice, has values of several kinds, or has the name of an element."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.finding import article, finding, related_to, written_text
from robbdd_tools.graph.property_facts import Fact, declared_facts
from robbdd_tools.graph.rdf.property_terms import property_name
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "property-value"


def property_value(site: Site) -> Iterator[Diagnostic]:
    """Report faulty properties in a set of elements. Of values of another kind, only the first one is reported."""
    root = site.tree
    if isinstance(root, tree.ElementSet):
        names = frozenset(member.name.text for member in root.members)
        stated = [member.properties for member in root.members]
    elif isinstance(root, tree.SimilarSet):
        names, stated = frozenset[str](), [root.properties]
    else:
        return
    for properties in stated:
        yield from _repeated(site, properties)
        for one in properties:
            if one.name.text in names:
                message = f"'{one.name.text}' is an element of this set, so it cannot be a property: rename one of them"
                yield finding(site, one.name, Severity.ERROR, CODE, message)
    yield from _of_known_facts(site, list(declared_facts(site.file, site.placed)))


def _repeated(site: Site, properties: tuple[tree.Property, ...]) -> Iterator[Diagnostic]:
    first: dict[str, tree.Property] = {}
    for stated in properties:
        before = first.setdefault(stated.name.text, stated)
        if before is stated or not before.values or not stated.values:
            continue
        known = [written_text(site, value) for value in before.values]
        more = [text for value in stated.values if (text := written_text(site, value)) not in known]
        end = site.span(before).end
        edits = (
            *(Edit(site.uri, Span(end, end), f", {text}") for text in (", ".join(more),) if text),
            *removal(site.file.document, "", site.span(stated)).edits,
        )
        name = stated.name.text
        yield finding(
            site,
            stated.name,
            Severity.WARNING,
            CODE,
            f"'{name}' is already stated: write its values in one list, as in '{name}: one, other'",
            (related_to(site, before, "the first values"),),
            (Fix("Add the values to the first list", edits),),
        )


def _of_known_facts(site: Site, found: list[Fact]) -> Iterator[Diagnostic]:
    kinds: dict[str, tuple[str, tree.Property]] = {}
    reported: set[str] = set()
    for fact in found:
        if fact.written is None or fact.name in reported:
            continue
        node = fact.written
        if property_name(fact.term) is None:
            reported.add(fact.name)
            message = "this namespace is that of a published vocabulary: declare the set in a namespace of your own"
            yield finding(site, node.name, Severity.ERROR, CODE, message)
            continue
        kind, other = kinds.setdefault(fact.name, (fact.value.measures, node))
        if kind != fact.value.measures:
            reported.add(fact.name)
            yield finding(
                site,
                node,
                Severity.WARNING,
                CODE,
                f"'{fact.name}' is {article(fact.value.measures)} here and {article(kind)} elsewhere in this set, so "
                "that its values cannot be compared: state values of one kind",
                (related_to(site, other, article(kind)),),
            )
