"""The coverage of requirements as a page: requirements by scenarios, with the verdicts of the latest runs."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

from robbdd_tools.features.pass_rates import outcome_of_all
from robbdd_tools.features.rejudged_results import SIGNS

if TYPE_CHECKING:
    from robbdd_tools.workbench.requirement_table import RequirementRow, ScenarioCell

SUFFIXES = (".html", ".htm")
_STYLE = """
:root { color-scheme: light dark; font: 15px/1.45 system-ui, sans-serif; }
body { margin: 2rem; }
table { border-collapse: collapse; }
th, td { border: 1px solid color-mix(in srgb, currentColor 25%, transparent); padding: .35rem .6rem; text-align: left;
  vertical-align: top; }
thead th { position: sticky; top: 0; background: Canvas; }
td.cell { text-align: center; white-space: nowrap; }
.holds { background: color-mix(in srgb, #2a9d4a 20%, transparent); }
.violated, .gap { background: color-mix(in srgb, #d33 22%, transparent); }
.open { background: color-mix(in srgb, #d90 22%, transparent); }
small { opacity: .8; }
"""


def coverage_page(rows: Sequence[RequirementRow], *, links_only: bool) -> str:
    """Return a page that needs no other file, with a row for each requirement and a column for each scenario.

    With ``links_only``, the page has no results: a cell only states that the scenario verifies the requirement.
    """
    scenarios = list(dict.fromkeys(cell.scenario for row in rows for cell in row.evidence))
    shown = sum(row.is_shown(links_only=links_only) for row in rows)
    proved = "verified by a scenario" if links_only else "shown by the last runs"
    heads = "".join(f'<th scope="col">{escape(name)}</th>' for name in scenarios)
    lines = "\n".join(_line(row, scenarios, links_only=links_only) for row in rows)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Coverage of requirements</title>
<style>{_STYLE}</style>
</head>
<body>
<h1>Coverage of requirements</h1>
<p>{shown} of {len(rows)} requirements {proved}.</p>
<table>
<thead><tr><th scope="col">Requirement</th><th scope="col">Verdict</th>{heads}</tr></thead>
<tbody>
{lines}
</tbody>
</table>
</body>
</html>
"""


def _line(row: RequirementRow, scenarios: Sequence[str], *, links_only: bool) -> str:
    label = f"{row.name} ({row.identifier})" if row.identifier else row.name
    source = f"<br><small>{escape(row.source)}</small>" if row.source else ""
    text = escape(row.text).replace("\n", "<br>")
    head = f'<th scope="row">{escape(label)}<br><small>{text}</small>{source}</th>'
    verdict = ("verified" if row.evidence else row.verdict) if links_only else row.verdict
    kind = "holds" if row.is_shown(links_only=links_only) else _KINDS.get(row.verdict, "open")
    found = {cell.scenario: cell for cell in row.evidence}
    cells = "".join(_cell(found.get(name), links_only=links_only) for name in scenarios)
    return f'<tr>{head}<td class="{kind}">{escape(verdict)}</td>{cells}</tr>'


_KINDS = {"violated": "violated", "no scenario": "gap"}
"""Verdict of a requirement → class of its cell; all others are open."""


def _cell(found: ScenarioCell | None, *, links_only: bool) -> str:
    if found is None:
        return "<td></td>"
    if links_only:
        return '<td class="cell holds">✔</td>'
    if not found.outcome:
        return '<td class="cell open">not run</td>'
    is_proof = found.outcome == "holds" and not found.remarks
    kind = "holds" if is_proof else "violated" if found.outcome == "violated" else "open"
    outcome = outcome_of_all(found.outcome, found.missing)
    remarks = "".join(f"<br><small>{word}</small>" for word in found.remarks)
    return f'<td class="cell {kind}">{SIGNS.get(outcome, "?")} {found.held}/{found.executions}{remarks}</td>'
