"""``foreign-variable``: a variant uses a variable of another template than its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Related, Severity
from robbdd_tools.checks.finding import change, finding
from robbdd_tools.checks.template_variants import VARIABLES, Scenario, scenarios
from robbdd_tools.names.types import variable_key
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site


def foreign_variable(site: Site) -> Iterator[Diagnostic]:
    """Report the variables of other templates in the variations and clauses of variants."""
    for scenario in scenarios(site):
        own = scenario.declared()
        if scenario.template is None:
            continue
        for ref in _variables(scenario):
            found = site.target(ref)
            if found is not None and variable_key(found) not in own and _is_of_template(scenario, found):
                yield _report(scenario, ref, found, own)


def _variables(scenario: Scenario) -> Iterator[tree.Ref]:
    """Yield the references to variables in a scenario, first the references in its variation."""
    yield from (column.ref for column in scenario.columns)
    yield from (use.ref for use in scenario.clauses.uses if use.bound is None)
    yield from (bound.in_set for bound in scenario.clauses.bounds)


def _is_of_template(scenario: Scenario, found: Definition) -> bool:
    """Return whether a definition is a variable of a template, and not of a quantifier in the variant."""
    extent = scenario.site.span(scenario.variant)
    inside = found.uri == scenario.site.uri and extent.contains(found.span.start)
    return found.kind in VARIABLES and not inside


def _is_column(scenario: Scenario, ref: tree.Ref) -> bool:
    return any(column.ref is ref for column in scenario.columns)


def _has_values(scenario: Scenario, variable: Definition) -> bool:
    key = variable_key(variable)
    return any(column.variable is not None and variable_key(column.variable) == key for column in scenario.columns)


def _report(scenario: Scenario, ref: tree.Ref, found: Definition, own: dict[str, Definition]) -> Diagnostic:
    template = scenario.variant.template.path
    same = [
        variable
        for variable in own.values()
        if (variable.symbol.name, variable.kind) == (found.symbol.name, found.kind)
        and not (_is_column(scenario, ref) and _has_values(scenario, variable))
    ]
    return finding(
        scenario.site,
        ref,
        Severity.ERROR,
        "foreign-variable",
        f"'{ref.path}' is not a variable of '{template}', the template of this scenario: "
        + (f"write '{same[0].symbol.path}'" if same else "name one of its variables, or another template"),
        (Related(found.uri, found.span, f"'{ref.path}' is declared here"),),
        tuple(
            change(scenario.site, f"Change to '{variable.symbol.path}'", ref, variable.symbol.path) for variable in same
        ),
    )
