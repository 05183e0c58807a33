"""``robbdd requirements``: coverage with exit codes, and tables both ways."""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path

import pytest

from checks.test_requirements import CLAUSE, NEED
from kit import EVENTS, SCENE, STORY
from robbdd_tools.cli import main
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.coverage_page import coverage_page
from robbdd_tools.workbench.requirement_table import (
    RequirementRow,
    ScenarioCell,
    TableProblem,
    model_text,
    read_table,
    table_text,
    verdict_of,
)

OTHER = 'Requirement (ns=t) R-2 { "Two\\nlines; \\"quoted\\", and a comma" id: "4.1/a" source: "spec.pdf §4" }\n'


def model(folder: Path, text: str) -> str:
    (folder / "lab.scene").write_text(SCENE, encoding="utf-8")
    path = folder / "main.bdd"
    path.write_text(EVENTS + text + CLAUSE + STORY, encoding="utf-8")
    return str(path)


def test_links_alone_are_enough_only_if_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = model(tmp_path, NEED)
    assert main(["requirements", path, "--links-only"]) == 0
    assert "✔ R-1: fetching.bench-to-tray\n1 of 1 requirements verified" in capsys.readouterr().out
    assert main(["requirements", path]) == 1
    assert "? R-1: not run, 0 of 0 executions (fetching.bench-to-tray)\n0 of 1" in capsys.readouterr().out


def test_a_requirement_without_a_scenario_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["requirements", model(tmp_path, NEED + OTHER), "--links-only"]) == 1
    assert "✗ R-2 (4.1/a): no scenario\n1 of 2" in capsys.readouterr().out


def test_a_requirement_of_which_some_scenarios_were_run_is_not_shown() -> None:
    def verdict(*missing: int | None) -> str:
        return verdict_of(
            [ScenarioCell("s", "holds", 2, 2, vacuous=False, stale=False, missing=one) for one in missing]
        )

    assert verdict(0, 0) == "holds"
    assert verdict(0, 2) == "not run in full"
    assert verdict(None) == "not run in full"
    cell = ScenarioCell("fetching.bench-to-tray", "holds", 2, 2, vacuous=False, stale=False, missing=2)
    row = RequirementRow("R-1", "", "It holds.", "", (cell,), verdict_of([cell]))
    assert not row.is_shown(links_only=False)
    page = coverage_page([row], links_only=False)
    assert '<td class="cell open">? 2/2<br><small>2 of 4 executed</small></td>' in page


def test_an_exported_table_is_imported_again(tmp_path: Path) -> None:
    table, again = tmp_path / "needs.csv", tmp_path / "again.bdd"
    main(["requirements", model(tmp_path, NEED + OTHER), "--links-only", "-o", str(table)])
    rows = list(csv.DictReader(table.open(encoding="utf-8", newline="")))
    assert [row["text"] for row in rows] == ["The part is in the tray.", 'Two\nlines; "quoted", and a comma']
    order = ["requirements", str(table), "-o", str(again), "--namespace", "https://example.org/t/"]
    assert main(order) == 0
    project = Project()
    project.open("file:///again.bdd", 1, again.read_text(encoding="utf-8"))
    file = project.snapshot().file("file:///again.bdd")
    assert file is not None
    assert file.diagnostics == ()
    assert 'Requirement (ns=req) R-2 {\n    "Two\\nlines; \\"quoted\\", and a comma"' in again.read_text(
        encoding="utf-8"
    )
    assert main(order) == 2, "the model exists"
    assert main([*order, "--force"]) == 0
    assert main(["requirements", str(table)]) == 2
    assert main([*order[:-1], "needs", "--force"]) == 2


@pytest.mark.parametrize("sign", [",", ";", "\t"])
def test_ids_of_other_tools_become_names(sign: str) -> None:
    lines = (("ID", "Owner", "Text"), ("SYS-7", "x", "One"), ("4.1/a", "", "Two"), ("SYS 7", "", "Three"))
    rows = read_table(Path("t.csv"), "\ufeff" + "\r\n".join(sign.join(line) for line in lines) + "\r\n\r\n")
    found = [(row.name, row.identifier, row.text) for row in rows]
    assert found == [("SYS-7", "", "One"), ("R-4-1-a", "4.1/a", "Two"), ("SYS-7-2", "SYS 7", "Three")]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "t.csv:1:1: the first row needs the columns 'text' and 'id' (or 'name'); it has nothing"),
        ("a,b\n", "t.csv:1:1: the first row needs the columns 'text' and 'id' (or 'name'); it has 'a', 'b'"),
        ('id,text\n1,"a\nb"\n2,\n', "t.csv:4:3: this requirement has no text: write what is required"),
        ("id,text\n,x\n", "t.csv:2:1: this requirement has neither a name nor an id"),
        ("text,name\nx,a b\n", "t.csv:2:3: 'a b' is no name of the language"),
        ('text,name\n"x, y",a\nz,a\n', "t.csv:3:3: 'a' is the name of the requirement in line 2, too"),
    ],
)
def test_a_bad_table_is_refused_at_its_cell(text: str, message: str) -> None:
    with pytest.raises(TableProblem) as problem:
        read_table(Path("t.csv"), text)
    assert str(problem.value).startswith(message)


def test_our_cells_are_those_of_the_csv_module() -> None:
    rows = read_table(Path("t.csv"), 'id,text,source\n1,"say ""x"", then ""y""",\n2,plain,"a,b"\n3,"unended')
    assert [(row.text, row.source) for row in rows[:2]] == [('say "x", then "y"', ""), ("plain", "a,b")]
    assert next(csv.reader([table_text(rows).splitlines()[1]]))[2] == 'say "x", then "y"'
    assert model_text(rows[:1], "x:").count("Requirement") == 1


@pytest.mark.parametrize("form", ["ttl", "json-ld"])
def test_requirements_of_a_graph_have_the_coverage_of_the_text(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], form: str
) -> None:
    text, graph = model(tmp_path, NEED + OTHER), tmp_path / f"needs.{form.replace('-', '')}"
    assert main(["graph", text, "--format", form]) == 0
    graph.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["requirements", text, "--links-only"]) == 1
    expected = capsys.readouterr().out
    assert "✔ R-1: fetching.bench-to-tray\n✗ R-2 (4.1/a): no scenario\n1 of 2" in expected
    assert main(["requirements", str(graph), "--links-only"]) == 1
    assert capsys.readouterr().out == expected
    assert main(["requirements", str(graph)]) == 1
    assert "? R-1: not run, 0 of 0 executions (fetching.bench-to-tray)" in capsys.readouterr().out


@pytest.mark.parametrize("first", ["ttl", "jsonld"])
def test_requirements_go_through_every_form_and_stay_the_same(tmp_path: Path, first: str) -> None:
    """Text → graph → text → ReqIF → graph → table → graph: the last graph is the first one."""
    name = "https://example.org/t/"
    chain = ["main.bdd", f"a.{first}", "b.bdd", "c.reqif", "d.ttl", "e.csv", f"f.{first}"]
    model(tmp_path, NEED + OTHER)
    for source, target in pairwise(tmp_path / one for one in chain):
        is_model = source.suffix == ".bdd"
        options = ["--links-only"] if is_model or target.suffix == ".csv" else ["--namespace", name]
        assert main(["requirements", str(source), "-o", str(target), *options]) in (0, 1)
    assert (tmp_path / chain[-1]).read_text(encoding="utf-8") == (tmp_path / chain[1]).read_text(encoding="utf-8")
    assert name + "R-2" in (tmp_path / "d.ttl").read_text(encoding="utf-8").replace("t:", name)


def test_requirements_of_other_tools_are_read_from_their_graph(tmp_path: Path) -> None:
    graph, text = tmp_path / "tool.ttl", tmp_path / "needs.bdd"
    graph.write_text(
        "@prefix o: <http://open-services.net/ns/rm#> .\n@prefix d: <http://purl.org/dc/terms/> .\n"
        '<https://tool.example/req/42> a o:Requirement ; d:identifier "SYS-7" ; d:title "Stop" ;\n'
        '  d:description "The arm stops." ; d:source <https://tool.example/spec> .\n'
        '<https://tool.example/req/R-3> a o:Requirement ; d:identifier "R-3" ; d:title "Only a title" .\n'
        "<https://tool.example/req/none> a o:Requirement .\n",
        encoding="utf-8",
    )
    assert main(["requirements", str(graph), "-o", str(text), "--namespace", "https://example.org/n/"]) == 0
    written = text.read_text(encoding="utf-8")
    assert 'SYS-7 {\n    "The arm stops."\n    source: "https://tool.example/spec"\n}' in written
    assert 'R-3 {\n    "Only a title"\n}' in written
    assert written.count("Requirement (") == 2


def test_a_broken_graph_is_refused_at_its_place_and_a_model_needs_a_namespace(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = tmp_path / "needs.ttl"
    graph.write_text("@prefix x: <https://x/> .\nx:a x:b [ .\n", encoding="utf-8")
    order = ["requirements", str(graph), "-o", str(tmp_path / "n.bdd")]
    assert main([*order, "--namespace", "https://x/"]) == 2
    assert f"{graph}:2:" in capsys.readouterr().err
    assert main(order) == 2
    assert "--namespace IRI" in capsys.readouterr().err
