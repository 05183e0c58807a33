"""``property-value``: a property is stated twice, has values of several kinds, or has the name of an element.

Also a mass or friction of an object that no simulation can have.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.property_values import NUMBER
from robbdd_tools.base.removals import removal
from robbdd_tools.catalog.settings import SettingError, setting_of
from robbdd_tools.checks.finding import article, finding, related_to, written_text
from robbdd_tools.graph.property_facts import Fact, declared_facts
from robbdd_tools.graph.rdf.property_terms import property_name
from robbdd_tools.graph.read.stated_settings import stated_setting
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
    known = list(declared_facts(site.file, site.placed))
    yield from _of_known_facts(site, known)
    if root.kind == "object":
        yield from _unsettable(site, known)


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


def _unsettable(site: Site, known: list[Fact]) -> Iterator[Diagnostic]:
    """Report a mass or friction that a simulated object cannot have. One without a unit describes only."""
    measures = {fact.value.measures for fact in known if fact.name == "mass"}
    # The members of a similar set share what is written.
    single = {id(fact.written): fact for fact in known if fact.written is not None and len(fact.written.values) == 1}
    for fact in single.values():
        assert fact.written is not None
        setting = stated_setting(fact.name, fact.value)
        if setting is not None:
            try:
                setting_of(fact.name).read(setting)
            except SettingError as error:
                message = f"no scene with this object can be set up: {error}"
                yield finding(site, fact.written, Severity.WARNING, CODE, message)
        elif fact.name == "mass" and measures == {NUMBER}:
            message = "a mass without a unit is not simulated: write its unit, as in '20 g'"
            end = site.span(fact.written).end
            fixes = tuple(Fix(f"Add '{unit}'", (Edit(site.uri, Span(end, end), f" {unit}"),)) for unit in ("g", "kg"))
            yield finding(site, fact.written, Severity.INFORMATION, CODE, message, fixes=fixes)


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
