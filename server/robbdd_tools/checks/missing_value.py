"""``missing-value``: a variant gives no value to a variable of its template."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Related, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.checks.finding import MAX_OFFERED, finding, listed
from robbdd_tools.checks.table_edits import columns_added
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.types import variable_key
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site


def missing_value(site: Site) -> Iterator[Diagnostic]:
    """Report all variables without a value, once for each variant.

    An unknown name in the variation may be the missing variable.
    """
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
        fix = f"add a column '<{first.symbol.path}>' to the table"
    else:
        words = "set var" if first.kind is SymbolKind.SET_VARIABLE else "var"
        fix = f"add a line '{words} <{first.symbol.path}>: …'"
    names = listed([variable.symbol.name for variable in missing])
    related = tuple(Related(found.uri, found.span, f"'{found.symbol.name}' is declared here") for found in missing)
    message = f"the scenario gives no value to {names} of its template: {fix}"
    fixes = tuple(_filled(scenario, missing))
    return finding(scenario.site, scenario.variant.name, Severity.ERROR, "missing-value", message, related, fixes)


def _filled(scenario: Scenario, missing: list[Definition]) -> Iterator[Fix]:
    """Yield fixes that add a line or a column for each missing variable, with values from the scene."""
    variation = scenario.variant.variation
    names = listed([variable.symbol.name for variable in missing])
    if isinstance(variation, tree.Table):
        yield from _columns(scenario, variation, missing)
    elif variation.assignments:
        fitting = [scenario.fitting_for(variable) for variable in missing]
        if all(fitting):
            edit = _lines(scenario, variation, missing, fitting)
            yield Fix(f"Give {names} all matching elements of the scene", (edit,))


def _lines(scenario: Scenario, product: tree.Product, missing: list[Definition], fitting: list[list[str]]) -> Edit:
    site = scenario.site
    document, end = site.file.document, site.span(product.assignments[-1]).end
    # For a scenario written in one line, text before it does not matter.
    begin = max(document.line_starts[document.position(end).line], site.span(scenario.variant).start)
    line = document.text[begin:end]
    lines: list[str] = []
    for variable, found in zip(missing, fitting, strict=True):
        values = f"{{ {', '.join(found)} }}"
        is_set = variable.kind is SymbolKind.SET_VARIABLE
        words, values = ("set var", f"{{ {values} }}") if is_set else ("var", values)
        lines.append(f"\n{line[: len(line) - len(line.lstrip())]}{words} <{variable.symbol.path}>: {values}")
    return Edit(site.uri, Span(end, end), "".join(lines))


def _columns(scenario: Scenario, table: tree.Table, missing: list[Definition]) -> Iterator[Fix]:
    """Yield fixes that add columns. For a single variable, there is one fix for each matching value.

    For several variables, one fix adds a column with the first matching value of each.
    """
    if len(missing) == 1 and missing[0].kind is SymbolKind.VARIABLE:
        choices = [[value] for value in scenario.fitting_for(missing[0])[:MAX_OFFERED]]
    else:
        cells = [scenario.cell_for(variable) for variable in missing]
        choices = [[cell for cell in cells if cell is not None]]
    heads = [f"<{variable.symbol.path}>" for variable in missing]
    for values in choices:
        edits = columns_added(scenario.site, table, heads, values) if len(values) == len(heads) else ()
        if edits:
            columns = "column" if len(heads) == 1 else "columns"
            yield Fix(f"Add the {columns} {' and '.join(heads)} with {' and '.join(values)}", edits)
