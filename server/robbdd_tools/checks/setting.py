"""``setting``: ``has config`` names a configuration that the catalog does not have, or a value that it cannot be.

A warning: other programs that execute a model may know other configurations; ours refuses to run with it.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.catalog.settings import SETTINGS, Setting, SettingError, setting_of
from robbdd_tools.checks.finding import change, finding, related_to
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.types import Written, variable_key, written_elements
from robbdd_tools.names.uses import Clauses, clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic, Fix
    from robbdd_tools.names.elements import Site

CODE = "setting"
LEAST_ALIKE = 0.6
"""Share of common letters from which a name is a suggestion."""


def setting(site: Site) -> Iterator[Diagnostic]:
    """Report unknown names where they are written, and values in the variations that give them."""
    for clauses in clauses_of(site.placed.declaration):
        for use in _uses(clauses):
            if use.name.text not in SETTINGS:
                yield _unknown(site, use.name)
    for scenario in scenarios(site):
        yield from _misfits(scenario)


class _Use:
    """``has config name = <value>``."""

    def __init__(self, phrase: tree.PhraseUse) -> None:
        slots = dict(phrase.arguments)
        name, value = slots["name"], slots["value"]
        assert isinstance(name, tree.Name)
        assert isinstance(value, tree.Ref)
        self.name, self.value = name, value


def _uses(clauses: Clauses) -> Iterator[_Use]:
    return (_Use(phrase) for phrase in clauses.phrases if phrase.word == "has-config")


def _unknown(site: Site, name: tree.Name) -> Diagnostic:
    close = get_close_matches(name.text, SETTINGS, n=3, cutoff=LEAST_ALIKE)
    message = f"there is no configuration '{name.text}'"
    message += f"; did you mean '{close[0]}'?" if close else f"; the known ones are {', '.join(SETTINGS)}"
    fixes = tuple(change(site, f"Change to '{found}'", name, found) for found in close)
    return finding(site, name, Severity.WARNING, CODE, message, fixes=fixes)


def _misfits(scenario: Scenario) -> Iterator[Diagnostic]:
    """Yield the values of a variation that the configurations which they are given to cannot have."""
    given: dict[str, tuple[Site, tree.Name]] = {}
    outer = scenario.outer
    for site, clauses in ((scenario.site, scenario.clauses), (scenario.template, outer)):
        if site is None or clauses is None:
            continue
        for use in _uses(clauses):
            variable = site.target(use.value)
            if variable is not None and use.name.text in SETTINGS:
                given.setdefault(variable_key(variable), (site, use.name))
    for column in scenario.columns:
        known = None if column.variable is None else given.get(variable_key(column.variable))
        if known is None or column.variable is None:
            continue
        is_set = column.variable.kind is SymbolKind.SET_VARIABLE
        for written in column.written:
            for node, text in _texts(scenario.site, written, is_set):
                try:
                    setting_of(known[1].text).read(text)
                except SettingError as error:
                    related = (related_to(*known, "the configuration"),)
                    fixes = _within_bounds(scenario.site, node, setting_of(known[1].text))
                    yield finding(scenario.site, node, Severity.WARNING, CODE, str(error), related, fixes)


def _within_bounds(site: Site, node: tree.Node, setting: Setting) -> tuple[Fix, ...]:
    """Return the fix that writes the nearest number which a configuration can have."""
    if not isinstance(node, tree.Number) or setting.count > 1:
        return ()
    nearest = min(max(node.value, setting.low), setting.high)
    text = f"{round(nearest) if setting.whole else nearest:g}"
    return (change(site, f"Change to {text}", node, text),)


def _texts(site: Site, written: Written, is_set: bool) -> Iterator[tuple[tree.Node, str]]:
    """Yield each value as the run reads it: the elements of a set variable are one value of several numbers."""
    if isinstance(written, tree.SetList):
        for values in written.sets:
            yield from _texts(site, values, is_set)
    elif is_set and isinstance(written, tree.ValueList | tree.Link):
        yield written, " ".join(element.name for _, element in written_elements(site, written))
    elif not isinstance(written, tree.Selection):
        yield from ((node, element.name) for node, element in written_elements(site, written))
