"""The Markdown summary of a run or a study."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

from campaign.executed import UNKNOWN, executions
from campaign.study_agents import QuickAgent, write_study
from campaign.test_report import Page
from robbdd_tools.campaign.report_markdown import report_markdown
from robbdd_tools.campaign.report_source import ReportSource, run_report
from robbdd_tools.cli import main
from robbdd_tools.graph.verified_requirements import LinkedRequirement, VerifyingVariant
from robbdd_tools.run import scheduler
from robbdd_tools.run.store import RunStore
from robbdd_tools.workbench.stored import PastRun
from run.recorded import CLAUSES, record_run


def source(**margins: list[float]) -> ReportSource:
    return ReportSource("m.bdd: run 1", tuple(executions(margins)), "", (), lambda _: "robbdd x", lambda _: ({}, ()))


def rendered(text: str) -> Page:
    """The summary as a reader sees it; each row of a table has as many cells as its head."""
    page = MarkdownIt("commonmark").enable("table").render(text)
    for one in re.findall("<table>.*?</table>", page, re.DOTALL):
        widths = {len(re.findall("<t[hd]", row)) for row in re.findall("<tr>.*?</tr>", one, re.DOTALL)}
        assert len(widths) == 1
    return Page(page)


def test_failures_come_first_the_worst_at_the_top() -> None:
    text = report_markdown(source(grip=[0.3, -0.1, UNKNOWN, -0.2], still=[0.1, 0.2, 0.3, -0.4]))
    assert text.startswith(
        "## ❌ m.bdd: run 1\n\n**1 of 4 executions hold**: 25.0 % [4.6 %, 69.9 %] · 2 violated · 1 unknown\n\n"
        "### Executions that do not hold\n\n"
    )
    rows = [line for line in text.split("<details>")[0].splitlines() if line.startswith("|")][2:]
    assert rows == [
        "| ❌ | e:v -- 4<br><sub>x = 3</sub> | ✗ grip | −200\u00a0mm |  |",
        "|  |  | ✗ still | −400\u00a0mm |  |",
        "| ❌ | e:v -- 2<br><sub>x = 1</sub> | ✗ grip | −100\u00a0mm |  |",
        "| ❔ | e:v -- 3<br><sub>x = 2</sub> | ? grip |  |  |",
    ]
    words = rendered(text).text
    assert "e:v -- 4 x = 3 verdict clause margin ✗ violated grip −200 mm ✗ violated still −400 mm" in words
    assert "Seed 3: robbdd x" in words


def test_clauses_that_fail_most_come_first_and_those_that_hold_are_closed() -> None:
    text = report_markdown(source(still=[0.1, 0.2], grip=[0.3, -0.1]))
    listed = text.partition("### Clauses")[2]
    assert 0 < listed.index("**grip**") < listed.index("**still**")
    row = "| ✗ | **grip** | 1 of 2 | 50.0 % [9.5 %, 90.5 %] | −100 mm | +100 mm |"
    assert row in text.replace("\u00a0", " ")
    calm = report_markdown(source(grip=[0.3, 0.1]))
    assert "### " not in calm
    assert "<summary>1 clauses, all held</summary>" in calm


def test_requirements_that_are_not_shown_come_first() -> None:
    variants = (VerifyingVariant("https://x/v", "s.v", {"https://x/grip": "grip"}, whole=False),)
    linked = LinkedRequirement("https://x/R", "R-1", "", "It grips.", "", variants)
    links = (linked, replace(linked, iri="https://x/O", name="R-2", variants=()))
    text = report_markdown(replace(source(grip=[0.3, 0.1]), requirements=links))
    opened, _, closed = text.partition("<summary>1 shown</summary>")
    assert "1 of 2 requirements shown, 1 without scenario." in opened
    assert "| ⚠️ no scenario | **R-2**<br>It grips. |  |  |" in opened
    assert "| ✅ holds | **R-1**<br>It grips. | s.v: 2 of 2 hold | grip |" in closed


def test_users_text_is_no_markup(tmp_path: Path) -> None:
    clause = replace(CLAUSES[0], name="`a|b` <b>", sentence='"e:a" *is* <script>alert(1)</script> | [x](y) &amp; `c`')
    run = PastRun(record_run(RunStore(tmp_path / "runs"), [-0.1], clauses=(clause,)))
    page = rendered(report_markdown(run_report(run)))
    assert "a *is* <script>alert(1)</script> | [x](y) &amp; `c`" in page.text
    assert {"script", "a", "b", "em"} & {tag for tag, _ in page.tags} == set()


def test_the_same_results_give_the_same_summary_and_many_are_cut() -> None:
    many = source(grip=[-0.01 * number for number in range(1, 31)])
    text = report_markdown(many)
    assert text == report_markdown(many)
    assert "10 more do not hold; the 20 worst are listed." in text


@pytest.mark.parametrize("what", ["latest", "x.study"])
def test_the_suffix_of_the_report_selects_the_summary(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path)
    assert main(["study", "run", what] if what.endswith("study") else ["run", "m.bdd", "--repeat", "10"]) == 1
    assert main(["report", what, "-o", "summary.md"]) == 0
    page = rendered(Path("summary.md").read_text(encoding="utf-8"))
    assert "of 40 executions hold" in page.text
    assert page.open == []
