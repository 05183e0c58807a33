"""The report of a run: one page that says what the run showed, and loads nothing."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from kit import write_manifest
from robbdd_tools.campaign.report_page import report_page
from robbdd_tools.campaign.report_source import run_report, used_file_rows
from robbdd_tools.cli import main
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.protocol.specs import ClauseSpec
from robbdd_tools.run.store import RunStore
from robbdd_tools.workbench.stored import PastRun
from run.recorded import CLAUSES, record_run

VOID = {"meta", "br", "input", "img"}


class Page(HTMLParser):
    """The words of a page, its tags, and those that are not closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not {"script", "style"} & set(self.open):
            self.words += data.split()

    @property
    def text(self) -> str:
        return " ".join(self.words)


@pytest.fixture
def store(tmp_path: Path) -> RunStore:
    return RunStore(tmp_path / ".robbdd" / "runs")


def page(store: RunStore, margins: list[float | None], clauses: tuple[ClauseSpec, ...] = CLAUSES[:1]) -> str:
    return report_page(run_report(PastRun(record_run(store, margins, clauses=clauses))))


def test_the_page_says_how_many_hold_and_how_sure_that_is(store: RunStore) -> None:
    text = Page(page(store, [0.3, 0.2, -0.1, None])).text
    assert "2 of 4 executions hold : 50.0 % [15.0 %, 85.0 %]. 1 violated, 1 unknown." in text
    assert "c5 Then a 5 2 1 1 50.0 % [15.0 %, 85.0 %] −100 mm +200 mm" in text


def test_margins_are_shown_even_if_the_first_execution_is_unknown(store: RunStore) -> None:
    text = Page(page(store, [None, 0.3, 0.2, -0.1])).text
    assert "c5 Then a 5 2 1 1 50.0 % [15.0 %, 85.0 %] −100 mm +200 mm" in text


def test_the_worst_executions_come_first_with_the_command_that_repeats_them(store: RunStore) -> None:
    found = Page(page(store, [0.3, -0.1, None, -0.2]))
    assert re.findall(r"[✗?] (?:violated|unknown) (e:v -- \d)", found.text) == ["e:v -- 4", "e:v -- 2", "e:v -- 3"]
    assert "simulate it again: robbdd replay 1 --scenario 'e:v -- 4'" in found.text
    assert "1 more do not hold" not in found.text


def test_contacts_that_no_clause_is_about_are_listed(store: RunStore) -> None:
    shelf = Contact("e:arm", "", "e:shelf", 1.5, 12.0, 1.6, 0.25)
    touching, clear = (record_run(store, [-0.1], contacts=contacts) for contacts in ((shelf,), ()))
    text = Page(report_page(run_report(PastRun(touching)))).text
    assert "Contacts that no clause is about: arm touches shelf at 1.50 s: at most 12.0 N at 1.60 s, 0.25 N s" in text
    assert "Contacts that" not in Page(report_page(run_report(PastRun(clear)))).text


def test_of_many_executions_that_do_not_hold_the_worst_are_shown(store: RunStore) -> None:
    text = page(store, [-0.01 * number for number in range(1, 31)])
    assert text.count('<summary><span class="violated">') == 20
    assert "10 more do not hold; the 20 worst are shown." in Page(text).text
    assert ">e:v -- 30<" in text
    assert "<h3>e:v -- 10<" not in text


def test_the_clauses_that_are_violated_most_often_are_named_first(store: RunStore) -> None:
    text = Page(page(store, [0.3, -0.1, -0.2, None], clauses=CLAUSES)).text
    assert "Violated most often: c5 in 2 of 4 , c6 in 2 of 4 executions ( the worst executions )." in text
    assert "Violated most often" not in page(store, [0.3])


def test_a_file_that_several_cells_of_a_study_used_is_listed_once() -> None:
    one = '{"../../person.xml": "abc"}'
    facts = {"name": "s", "files ": one, "files scene=b": one, "files scene=c": '{"../../person.xml": "def"}'}
    assert used_file_rows(facts) == [("file person.xml", "abc"), ("file person.xml", "def")]


def test_factors_with_several_levels_can_be_chosen(store: RunStore) -> None:
    text = page(store, [0.3, -0.1])
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text)
    assert found is not None
    data = json.loads(found[1])
    assert data["matrix"] == {
        "scenarios": ["e:v -- 1 (x = 0)", "e:v -- 2 (x = 1)"],
        "clauses": ["c5"],
        "of": [0, 1],
        "judged": ["h", "v"],
    }
    assert data["factors"] == [{"name": "x", "levels": ["0", "1"], "of": [0, 1]}]
    assert data["verdicts"] == ["holds", "violated"]
    assert "<select" not in page(store, [0.3])


def test_the_page_loads_nothing_and_is_well_formed(store: RunStore) -> None:
    found = Page(page(store, [0.3, -0.1]))
    assert found.open == []
    assert {"src", "action"} & {name for _, attributes in found.tags for name in attributes} == set()
    # Links lead to sections of the page, all of which are there.
    links = {attributes["href"] for _, attributes in found.tags if "href" in attributes}
    assert links <= {f"#{attributes['id']}" for _, attributes in found.tags if "id" in attributes}
    (policy,) = [one["content"] for tag, one in found.tags if tag == "meta" and "http-equiv" in one]
    assert policy is not None
    assert policy.startswith("default-src 'none'")


def test_names_and_sentences_are_text(store: RunStore) -> None:
    hostile = ClauseSpec(5, "https://x/c", "<script>alert(1)</script>", "then", "</script>\x1b[2J")
    text = page(store, [-0.1], (hostile,))
    found = Page(text)
    assert "<script>alert(1)</script>" in found.text
    assert "</script>\\x1b[2J" in found.text
    assert "\x1b" not in text
    assert "alert" not in "".join(re.findall(r"<script>(.*?)</script>", text, re.DOTALL))
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)
    assert "<" not in data
    assert json.loads(data)["matrix"]["clauses"] == ["<script>alert(1)</script>"]


def test_a_level_cannot_end_the_script(store: RunStore) -> None:
    run = record_run(store, [0.3, 0.2])
    manifest = run.manifest()
    specs = tuple(
        replace(spec, values={"e:var-x": f"</script>{number}"}) for number, spec in enumerate(manifest.scenarios)
    )
    write_manifest(run.folder, replace(manifest, scenarios=specs))
    text = report_page(run_report(PastRun(run)))
    assert Page(text).open == []
    assert '"levels": ["\\u003c/script>0", "\\u003c/script>1"]' in text


def test_the_same_run_gives_the_same_bytes(store: RunStore) -> None:
    run = PastRun(record_run(store, [0.3, -0.1, None]))
    assert report_page(run_report(run)) == report_page(run_report(run))


def test_a_large_run_has_a_small_page(store: RunStore) -> None:
    margins: list[float | None] = [0.1 - 0.001 * (number % 120) for number in range(1680)]
    assert len(page(store, margins, CLAUSES).encode()) < 1_000_000


def test_the_command_writes_the_page_and_explains_an_unknown_run(
    store: RunStore, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record_run(store, [0.3])
    assert main(["report", "latest", str(tmp_path), "-o", str(tmp_path / "out.html")]) == 0
    assert "1 of 1 executions hold" in Page((tmp_path / "out.html").read_text(encoding="utf-8")).text
    assert main(["report", "9", str(tmp_path), "-o", str(tmp_path / "out.html")]) == 2
    assert "there is no run '9'" in capsys.readouterr().err
