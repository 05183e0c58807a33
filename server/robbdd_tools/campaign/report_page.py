"""The report of a run or a study as one HTML page that needs no network."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.report_data import MOST_SHOWN, clause_rows, counts, factors, failed_rows, failing_clauses
from robbdd_tools.campaign.report_factors import (
    confounding_words,
    effect_rows,
    flaky_scenarios,
    matrix_data,
    repeated,
    script_json,
)
from robbdd_tools.campaign.requirement_rows import requirement_results, requirement_summary
from robbdd_tools.run.report import SIGNS

if TYPE_CHECKING:
    from jinja2 import Template

    from robbdd_tools.campaign.report_source import ReportSource


def report_page(source: ReportSource, moments: str = "", problem: str = "") -> str:
    """Return a report as HTML.

    The page contains everything that it shows. ``moments`` is the JSON of ``Moments.document``; ``problem`` is the
    reason why pictures are missing. Raises ``NoSuchRun`` and ``StatisticsNotInstalled``.
    """
    results = source.results
    summary = counts(result.verdict for result in results)
    failed, varied, clauses = failed_rows(source), factors(results), clause_rows(results)
    required = requirement_results(source.requirements, results)
    heat = {
        "factors": [{"name": one.name, "levels": one.levels, "of": one.of} for one in varied],
        "verdicts": [str(result.verdict) for result in results],
        "matrix": matrix_data(results),
    }
    return template("report.html").render(
        title=source.title,
        summary=summary,
        state=source.state,
        requirements=required,
        shown=requirement_summary(required),
        coverage=source.coverage,
        clauses=clauses,
        failing=failing_clauses(clauses),
        sentences=any(row.sentence for row in clauses),
        factors=varied,
        effects=effect_rows(varied, results),
        confounded=confounding_words(varied),
        flaky=flaky_scenarios(results) if repeated(results) else None,
        data=script_json(heat),
        failed=failed,
        more=summary.violated + summary.unknown - len(failed),
        most=MOST_SHOWN,
        environment=source.environment,
        signs={str(outcome): sign for outcome, sign in SIGNS.items()},
        moments=moments.replace("<", "\\u003c"),
        problem=problem,
    )


@cache
def template(name: str) -> Template:
    """Return a template of a page of this package."""
    from jinja2 import Environment, PackageLoader
    from markupsafe import Markup

    def shown(value: Any) -> Any:
        """Escape characters that could control a terminal or hide text, in everything but the plots."""
        return printable(value) if isinstance(value, str) and not isinstance(value, Markup) else value

    loader = PackageLoader("robbdd_tools.campaign", "")
    environment = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, finalize=shown)
    environment.filters["rate"] = unbroken_rate
    return environment.get_template(name)


def unbroken_rate(words: str) -> str:
    """Return a rate with its interval as text that is broken into lines only before the interval."""
    return words.replace(" ", "\u00a0").replace("\u00a0[", " [")
