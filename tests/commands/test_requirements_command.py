"""``robbdd requirements``: coverage with exit codes, and tables both ways."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from checks.test_requirements import CLAUSE, NEED
from kit import EVENTS, SCENE, STORY
from robbdd_tools.cli import main
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.requirement_table import TableProblem, model_text, read_table, table_text

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


def test_a_graph_is_not_taken_for_a_model_without_requirements(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = tmp_path / "needs.ttl"
    assert main(["graph", model(tmp_path, NEED)]) == 0
    graph.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["requirements", str(graph)]) == 2
    command = capsys.readouterr().err.partition("(robbdd ")[2].partition(")")[0].split()
    text = tmp_path / "text.bdd"
    assert main([*command[:-1], str(text)]) == 0
    assert main(["requirements", str(text), "--links-only"]) == 0
    assert "R-1: fetching.bench-to-tray" in capsys.readouterr().out
