"""``missing-value``: a variant that gives no value to a variable of its template."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Related, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.checks.finding import finding, listed
from robbdd_tools.checks.variants import Scenario, scenarios
from robbdd_tools.names.elements import scene_members
from robbdd_tools.names.types import variable_key, variable_type
from robbdd_tools.names.uses import ELEMENTS
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import Definition
    from robbdd_tools.names.elements import Site


def missing_value(site: Site) -> Iterator[Diagnostic]:
    """Report once per variant all variables that get no value; an unknown name may be the missing one."""
    for scenario in scenarios(site):
        given = [column.variable for column in scenario.columns if column.variable is not None]
        if len(given) < len(scenario.columns):
            continue
        keys = {variable_key(variable) for variable in given}
        missing = [variable for key, variable in scenario.declared().items() if key not in keys]
        if missing:
            yield _report(scenario, missing)


def _report(scenario: Scenario, missing: list[Definition]) -> Diagnostic:
    first = missing[0]
    if isinstance(scenario.variant.variation, tree.Table):
        mend = f"add a column '<{first.symbol.path}>' to the table"
    else:
        words = "set var" if first.kind is SymbolKind.SET_VARIABLE else "var"
        mend = f"add a line '{words} <{first.symbol.path}>: …'"
    names = listed([variable.symbol.name for variable in missing])
    related = tuple(Related(found.uri, found.span, f"'{found.symbol.name}' is declared here") for found in missing)
    message = f"the scenario gives no value to {names} of its template: {mend}"
    fixes = tuple(_filled(scenario, missing))
    return finding(scenario.site, scenario.variant.name, Severity.ERROR, "missing-value", message, related, fixes)


def _filled(scenario: Scenario, missing: list[Definition]) -> Iterator[Fix]:
    """Yield the lines of a product that give each variable all that its scene has for it."""
    site, variation = scenario.site, scenario.variant.variation
    members = scene_members(site.follow(scenario.variant.scene))
    if not isinstance(variation, tree.Product) or not variation.assignments or members is None:
        return
    document, end = site.file.document, site.span(variation.assignments[-1]).end
    line = document.line_text(document.position(end).line)
    lines: list[str] = []
    for variable in missing:
        kinds = variable_type(site.snapshot, variable, from_values=False).kinds & ELEMENTS
        fitting = sorted((member for member in members if member.kind in kinds), key=lambda member: member.key)
        if not fitting:
            return
        values = f"{{ {', '.join(f'<{member.name}>' for member in fitting)} }}"
        is_set = variable.kind is SymbolKind.SET_VARIABLE
        words, values = ("set var", f"{{ {values} }}") if is_set else ("var", values)
        lines.append(f"\n{line[: len(line) - len(line.lstrip())]}{words} <{variable.symbol.path}>: {values}")
    names = listed([variable.symbol.name for variable in missing])
    yield Fix(f"Give {names} all that fits in the scene", (Edit(site.uri, Span(end, end), "".join(lines)),))
