"""``setting``: ``has config`` has an unknown configuration, an invalid value, or an element without the configuration.

This is a warning, because other programs that execute a model may know other configurations. RobBDD refuses to run such
a scenario.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.catalog.object_settings import agent_has, object_has
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.settings import SETTINGS, Setting, SettingError, setting_of
from robbdd_tools.checks.chosen_elements import written_elements
from robbdd_tools.checks.finding import article, change, finding, related_to
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import element_of
from robbdd_tools.names.types import Written, variable_key
from robbdd_tools.names.uses import ELEMENTS, Clauses, clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic, Fix
    from robbdd_tools.catalog.api import ObjectModel
    from robbdd_tools.names.elements import Element, Site

CODE = "setting"
_SHARED = frozenset({"contact_time", "drop_height", "position_range", "seed"})
"""Configurations that agents and objects have in common."""
MIN_ALIKE = 0.6
"""Minimum similarity of a suggestion."""
MISSPELT = 0.8
"""Minimum similarity from which a name counts as misspelt."""
MAX_ALIKE = 5
"""Maximum number of suggestions."""
_WORD = re.compile(r"[a-z]{4,}")
"""A word of a name that is long enough to be characteristic."""


def setting(site: Site) -> Iterator[Diagnostic]:
    """Report unknown names. Report invalid values in the variations that contain them."""
    for clauses in clauses_of(site.placed.declaration):
        for use in _uses(clauses):
            if use.name.text not in SETTINGS:
                yield _unknown(site, use.name)
            else:
                yield from _stated(site, use)
    for scenario in scenarios(site):
        yield from _misfits(scenario)
        yield from _wrong_targets(scenario)


class _Use:
    """``has config name = <value>``."""

    def __init__(self, phrase: tree.PhraseUse) -> None:
        slots = dict(phrase.arguments)
        name, value, target = slots["name"], slots["value"], slots["target"]
        assert isinstance(name, tree.Name)
        assert isinstance(value, tree.Ref | tree.Number | tree.Text)
        assert isinstance(target, tree.Ref)
        self.name, self.value, self.target = name, value, target


def _uses(clauses: Clauses) -> Iterator[_Use]:
    return (_Use(phrase) for phrase in clauses.phrases if phrase.word == "has-config")


def _unknown(site: Site, name: tree.Name) -> Diagnostic:
    message, close = unknown_setting(name.text)
    fixes = tuple(change(site, f"Change to '{found}'", name, found) for found in close)
    return finding(site, name, Severity.WARNING, CODE, message, fixes=fixes)


def unknown_setting(name: str) -> tuple[str, list[str]]:
    """Return the message on an unknown name, and the names of similar configurations, the most similar first."""
    close = _similar(name)
    message = f"there is no configuration '{name}'"
    if not close:
        return f"{message}; the known ones are {', '.join(SETTINGS)}", close
    choices = [f"'{one}' ({setting_of(one).target})" for one in close]
    *others, last = choices if len(choices) > 1 else [f"'{close[0]}'"]
    return f"{message}; did you mean {', '.join(others)}{' or ' if others else ''}{last}?", close


def _similar(name: str) -> list[str]:
    """Return the configurations that a name resembles.

    These are the configurations that share a word with the name (as ``ee_speed`` does with ``speed``), and those of
    which the name may be a misspelling.
    """
    words = set(_WORD.findall(name.lower()))
    shares = {one: bool(words & set(_WORD.findall(one))) for one in SETTINGS}
    alike = {one: SequenceMatcher(None, name.lower(), one).ratio() for one in SETTINGS}
    found = [one for one in SETTINGS if shares[one] or alike[one] >= MISSPELT]
    found = found or [one for one in SETTINGS if alike[one] >= MIN_ALIKE]
    return sorted(found, key=lambda one: (not shares[one], -alike[one]))[:MAX_ALIKE]


def _stated(site: Site, use: _Use) -> Iterator[Diagnostic]:
    """Report the value of a clause if it is invalid, and the element if it does not have the configuration."""
    if not isinstance(use.value, tree.Ref):
        try:
            setting_of(use.name.text).read(str(use.value.value))
        except SettingError as error:
            fixes = _within_bounds(site, use.value, setting_of(use.name.text))
            yield finding(site, use.value, Severity.WARNING, CODE, str(error), fixes=fixes)
    element = element_of(site, use.target)
    is_element = element is not None and element.kind in ELEMENTS
    if element is not None and is_element and not may_have(element.kind, _model(element), use.name.text):
        message = not_configurable(element.name, _model(element), element.kind, use.name.text)
        yield finding(site, use.target, Severity.WARNING, CODE, message)


def _misfits(scenario: Scenario) -> Iterator[Diagnostic]:
    """Yield the invalid configuration values of a variation."""
    given: dict[str, tuple[Site, tree.Name]] = {}
    for site, use in _known_uses(scenario):
        variable = site.target(use.value) if isinstance(use.value, tree.Ref) else None
        if variable is not None:
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


def _known_uses(scenario: Scenario) -> Iterator[tuple[Site, _Use]]:
    """Yield the configurations of the catalog that the clauses of a scenario and of its template name."""
    for site, clauses in ((scenario.site, scenario.clauses), (scenario.template, scenario.outer)):
        if site is not None and clauses is not None:
            yield from ((site, use) for use in _uses(clauses) if use.name.text in SETTINGS)


def _wrong_targets(scenario: Scenario) -> Iterator[Diagnostic]:
    """Report the elements in a variation that clauses configure but that do not have the configuration."""
    targets: dict[str, list[tuple[Site, tree.Name]]] = {}
    for site, use in _known_uses(scenario):
        variable = site.target(use.target)
        if variable is not None:
            targets.setdefault(variable_key(variable), []).append((site, use.name))
    for column in scenario.columns if targets else ():
        for site, name in targets.get(variable_key(column.variable), ()) if column.variable is not None else ():
            for written in column.written:
                for node, element in written_elements(scenario.site, written):
                    if not may_have(element.kind, _model(element), name.text):
                        message = not_configurable(element.name, _model(element), element.kind, name.text)
                        related = (related_to(site, name, "the configuration"),)
                        yield finding(scenario.site, node, Severity.WARNING, CODE, message, related)


def _model(element: Element) -> ObjectModel | None:
    *sets, own = element.name.split(".")
    return load_catalog().object_for(own, sets) if element.kind == "object" else None


def not_configurable(element: str, model: ObjectModel | None, kind: str, name: str) -> str:
    """Return the message on an element without a configuration."""
    what = article(kind) if model is None else f"the model '{model.name}' of the catalog"
    return f"'{element}' ({what}) has no {name}: it applies to {setting_of(name).target}"


def may_have(kind: str, model: ObjectModel | None, name: str) -> bool:
    """Return whether an element may have a configuration of the catalog.

    ``model`` is the catalog's model of an object. The models of a ``.scenex`` are known only in a run.
    """
    match kind:
        case "agent":
            return agent_has(name)
        case "object":
            return not (agent_has(name) and name not in _SHARED) if model is None else object_has(model, name)
        case "workspace":
            return name in _SHARED or not agent_has(name)
        case _:
            return True


def _within_bounds(site: Site, node: tree.Node, setting: Setting) -> tuple[Fix, ...]:
    """Return the fix that writes the nearest valid number."""
    if not isinstance(node, tree.Number) or setting.count > 1:
        return ()
    nearest = min(max(node.value, setting.low), setting.high)
    text = f"{round(nearest) if setting.whole else nearest:g}"
    return (change(site, f"Change to {text}", node, text),)


def _texts(site: Site, written: Written, is_set: bool) -> Iterator[tuple[tree.Node, str]]:
    """Yield each value in the form in which a run reads it.

    For a set variable, the elements of the set together are one value that consists of several numbers.
    """
    if isinstance(written, tree.SetList):
        for values in written.sets:
            yield from _texts(site, values, is_set)
    elif is_set and isinstance(written, tree.ValueList | tree.Link):
        yield written, " ".join(element.name for _, element in written_elements(site, written))
    elif not isinstance(written, tree.Selection):
        yield from ((node, element.name) for node, element in written_elements(site, written))
