"""What rules report of models, and what each of their fixes changes; ``reports/`` has the models and the answers."""

from __future__ import annotations

from pathlib import Path

import pytest

from report_kit import check_report
from robbdd_tools.checks import DECLARATION_RULES, FILE_RULES

REPORTS = sorted((Path(__file__).parent / "reports").glob("*.txt"))
ON_DISK = {"python-source"}
"""Rules that read files beside the model; ``test_executions.py`` writes these."""


@pytest.mark.parametrize("path", REPORTS, ids=lambda path: path.stem)
def test_a_model_is_reported_as_before(path: Path) -> None:
    check_report(path)


def test_every_rule_has_a_model_that_it_reports() -> None:
    reported = {line.partition(" ")[0] for path in REPORTS for line in path.read_text(encoding="utf-8").splitlines()}
    rules = {rule.__name__.replace("_", "-") for rule in (*DECLARATION_RULES, *FILE_RULES)}
    assert rules - ON_DISK <= reported
