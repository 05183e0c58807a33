"""What is reported of names and imports; ``reports/`` has the models and the answers."""

from __future__ import annotations

from pathlib import Path

import pytest

from report_kit import check_report

REPORTS = sorted((Path(__file__).parent / "reports").glob("*.txt"))


@pytest.mark.parametrize("path", REPORTS, ids=lambda path: path.stem)
def test_a_model_is_reported_as_before(path: Path) -> None:
    check_report(path)
