"""The report of a run as one HTML page that needs no network."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.report_data import MOST_SHOWN, clause_rows, counts, factors, failed_rows
from robbdd_tools.run.report import SIGNS

if TYPE_CHECKING:
    from jinja2 import Template

    from robbdd_tools.campaign.report_data import Factor
    from robbdd_tools.workbench.execution_rows import ExecutionResult
    from robbdd_tools.workbench.stored import PastRun


def report_page(run: PastRun) -> str:
    """Return the report of a stored run as HTML.

    The page contains everything that it shows. Raises ``NoSuchRun`` and ``StatisticsNotInstalled``.
    """
    results, record, status = run.results, run.record, run.status
    summary = counts(result.verdict for result in results)
    failed = failed_rows(run, results)
    return _template().render(
        title=f"{record.path}: run {run.number}" if run.number else record.path,
        summary=summary,
        state=status.words(),
        clauses=clause_rows(results),
        factors=factors(results),
        # The text is in a script element: no end tag may be in it.
        data=json.dumps(_heat_data(factors(results), results)).replace("<", "\\u003c"),
        failed=failed,
        more=summary.violated + summary.unknown - len(failed),
        most=MOST_SHOWN,
        environment=_environment(run),
        signs={str(outcome): sign for outcome, sign in SIGNS.items()},
    )


def _heat_data(found: list[Factor], results: tuple[ExecutionResult, ...]) -> dict[str, Any]:
    return {
        "factors": [{"name": one.name, "levels": one.levels, "of": one.of} for one in found],
        "verdicts": [str(result.verdict) for result in results],
    }


def _environment(run: PastRun) -> list[tuple[str, str]]:
    record = run.record
    rows = [("model", record.path), ("digest of its graph", record.digest), ("seed", str(record.seed))]
    rows += [("RobBDD", record.version), ("simulator", record.simulator), ("log", record.log)]
    rows += [(f"file {path}", digest) for path, digest in sorted(record.files.items())]
    return [(name, value) for name, value in rows if value]


@cache
def _template() -> Template:
    from jinja2 import Environment, PackageLoader
    from markupsafe import Markup

    def shown(value: Any) -> Any:
        """Escape what could control a terminal or hide text, in everything but the plots."""
        return printable(value) if isinstance(value, str) and not isinstance(value, Markup) else value

    loader = PackageLoader("robbdd_tools.campaign", "")
    environment = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, finalize=shown)
    return environment.get_template("report.html")
