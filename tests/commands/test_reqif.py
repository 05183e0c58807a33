"""ReqIF both ways, and the page of coverage: ``robbdd requirements``."""

from __future__ import annotations

import html
import json
import re
import shutil
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from checks.test_requirements import NEED
from commands.test_requirements_command import OTHER, model
from kit import EXAMPLES
from robbdd_tools.cli import main
from robbdd_tools.workbench.reqif_file import read_reqif, reqif_text
from robbdd_tools.workbench.requirement_table import RequirementRow, TableProblem

FILE = Path("s.reqif")
ROWS = [
    RequirementRow("R-1", "", "One & <two>\nsecond \"line\" 'x'", "spec.pdf §4"),
    RequirementRow("R-4-1-a", "4.1/a", "Größe ≤ 5 mm", ""),
]
FOREIGN = """<?xml version="1.0" encoding="UTF-8"?>
<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd" xmlns:xhtml="http://www.w3.org/1999/xhtml">
 <CORE-CONTENT><REQ-IF-CONTENT>
  <DATATYPES>
   <DATATYPE-DEFINITION-STRING IDENTIFIER="d-s" LAST-CHANGE="2020-01-01T00:00:00Z" MAX-LENGTH="99"/>
   <DATATYPE-DEFINITION-XHTML IDENTIFIER="d-x" LAST-CHANGE="2020-01-01T00:00:00Z"/>
  </DATATYPES>
  <SPEC-TYPES><SPEC-OBJECT-TYPE IDENTIFIER="t" LAST-CHANGE="2020-01-01T00:00:00Z"><SPEC-ATTRIBUTES>
   <ATTRIBUTE-DEFINITION-XHTML IDENTIFIER="a-text" LONG-NAME="Object Text" LAST-CHANGE="2020-01-01T00:00:00Z">
    <TYPE><DATATYPE-DEFINITION-XHTML-REF>d-x</DATATYPE-DEFINITION-XHTML-REF></TYPE></ATTRIBUTE-DEFINITION-XHTML>
   <ATTRIBUTE-DEFINITION-STRING IDENTIFIER="a-head" LONG-NAME="Object Heading" LAST-CHANGE="2020-01-01T00:00:00Z">
    <TYPE><DATATYPE-DEFINITION-STRING-REF>d-s</DATATYPE-DEFINITION-STRING-REF></TYPE></ATTRIBUTE-DEFINITION-STRING>
   <ATTRIBUTE-DEFINITION-STRING IDENTIFIER="a-id" LONG-NAME="Object Identifier" LAST-CHANGE="2020-01-01T00:00:00Z">
    <TYPE><DATATYPE-DEFINITION-STRING-REF>d-s</DATATYPE-DEFINITION-STRING-REF></TYPE></ATTRIBUTE-DEFINITION-STRING>
  </SPEC-ATTRIBUTES></SPEC-OBJECT-TYPE></SPEC-TYPES>
  <SPEC-OBJECTS>
   <SPEC-OBJECT IDENTIFIER="o-2" LAST-CHANGE="2020-01-01T00:00:00Z"><VALUES>
    <ATTRIBUTE-VALUE-STRING THE-VALUE="SRS 2"><DEFINITION>
     <ATTRIBUTE-DEFINITION-STRING-REF>a-id</ATTRIBUTE-DEFINITION-STRING-REF></DEFINITION></ATTRIBUTE-VALUE-STRING>
    <ATTRIBUTE-VALUE-XHTML><DEFINITION><ATTRIBUTE-DEFINITION-XHTML-REF>a-text</ATTRIBUTE-DEFINITION-XHTML-REF></DEFINITION>
     <THE-VALUE><xhtml:div>The arm <xhtml:b>stops</xhtml:b>
       at once.<xhtml:br/>Always.</xhtml:div></THE-VALUE></ATTRIBUTE-VALUE-XHTML>
   </VALUES><TYPE><SPEC-OBJECT-TYPE-REF>t</SPEC-OBJECT-TYPE-REF></TYPE></SPEC-OBJECT>
   <SPEC-OBJECT IDENTIFIER="o-1" LAST-CHANGE="2020-01-01T00:00:00Z"><VALUES>
    <ATTRIBUTE-VALUE-STRING THE-VALUE="1 Safety"><DEFINITION>
     <ATTRIBUTE-DEFINITION-STRING-REF>a-head</ATTRIBUTE-DEFINITION-STRING-REF></DEFINITION></ATTRIBUTE-VALUE-STRING>
   </VALUES><TYPE><SPEC-OBJECT-TYPE-REF>t</SPEC-OBJECT-TYPE-REF></TYPE></SPEC-OBJECT>
   <SPEC-OBJECT IDENTIFIER="o-3" LONG-NAME="LAST" LAST-CHANGE="2020-01-01T00:00:00Z"><VALUES>
    <ATTRIBUTE-VALUE-XHTML><DEFINITION><ATTRIBUTE-DEFINITION-XHTML-REF>a-text</ATTRIBUTE-DEFINITION-XHTML-REF></DEFINITION>
     <THE-VALUE><xhtml:div>The part is held.</xhtml:div></THE-VALUE></ATTRIBUTE-VALUE-XHTML>
   </VALUES><TYPE><SPEC-OBJECT-TYPE-REF>t</SPEC-OBJECT-TYPE-REF></TYPE></SPEC-OBJECT>
  </SPEC-OBJECTS>
  <SPECIFICATIONS><SPECIFICATION IDENTIFIER="s" LAST-CHANGE="2020-01-01T00:00:00Z"><CHILDREN>
   <SPEC-HIERARCHY IDENTIFIER="h-1" LAST-CHANGE="2020-01-01T00:00:00Z">
    <OBJECT><SPEC-OBJECT-REF>o-1</SPEC-OBJECT-REF></OBJECT>
    <CHILDREN>
     <SPEC-HIERARCHY IDENTIFIER="h-3" LAST-CHANGE="2020-01-01T00:00:00Z">
      <OBJECT><SPEC-OBJECT-REF>o-3</SPEC-OBJECT-REF></OBJECT></SPEC-HIERARCHY>
     <SPEC-HIERARCHY IDENTIFIER="h-2" LAST-CHANGE="2020-01-01T00:00:00Z">
      <OBJECT><SPEC-OBJECT-REF>o-2</SPEC-OBJECT-REF></OBJECT></SPEC-HIERARCHY>
    </CHILDREN></SPEC-HIERARCHY>
  </CHILDREN></SPECIFICATION></SPECIFICATIONS>
 </REQ-IF-CONTENT></CORE-CONTENT>
</REQ-IF>
"""
"""As tools write it: formatted text, a heading, and an order of the specification that is not that of the objects."""


LINE = FOREIGN[: FOREIGN.index('<SPEC-OBJECT IDENTIFIER="o-3"')].count("\n") + 1


def test_requirements_come_back_unchanged_and_equal_ones_have_equal_files() -> None:
    text = reqif_text(FILE, ROWS)
    assert read_reqif(FILE, text) == ROWS
    assert reqif_text(FILE, ROWS) == text


def test_a_file_fits_the_schema_of_reqif() -> None:
    schema = import_module("xmlschema")
    folder = Path(str(import_module("reqif").__file__)).parent / "reqif_schema"
    (found,) = folder.glob("reqif.xsd")
    schema.XMLSchema(str(found)).validate(reqif_text(FILE, ROWS))


def test_a_file_of_another_tool_is_read_in_the_order_of_its_specification() -> None:
    found = [(row.name, row.identifier, row.text) for row in read_reqif(FILE, FOREIGN)]
    assert found == [
        ("LAST", "", "The part is held."),
        ("SRS-2", "SRS 2", "The arm stops at once.\nAlways."),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "s.reqif:1:1: this is no XML: Document is empty"),
        ("<a>", "s.reqif:1:4: this is no XML: Premature end of data in tag a line 1"),
        ("<a/>", "s.reqif:1:1: this is no ReqIF: Expected root tag to be REQ-IF, got: a"),
        ("<REQ-IF/>", "s.reqif:1:1: there is no SPEC-OBJECT"),
        ('<?xml version="1.0"?>\n <!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "s.reqif:2:2: ReqIF has no document type"),
        (FOREIGN.replace('"Object Text"', '"Remark"'), f"s.reqif:{LINE}:28: 'o-3' has no text in an attribute such as"),
        (FOREIGN.replace("<SPEC-OBJECT-REF>o-3</SPEC-OBJECT-REF>", ""), "s.reqif:1:1: this is no ReqIF: "),
    ],
)
def test_a_bad_file_is_refused_with_its_place(text: str, message: str) -> None:
    with pytest.raises(TableProblem) as problem:
        read_reqif(FILE, text)
    assert str(problem.value).startswith(message)


def test_a_specification_becomes_a_model_and_a_model_a_specification(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source, again, back = tmp_path / "spec.reqif", tmp_path / "needs.bdd", tmp_path / "back.reqif"
    source.write_text(FOREIGN, encoding="utf-8")
    assert main(["requirements", str(source), "-o", str(again), "--namespace", "https://example.org/t/"]) == 0
    assert main(["requirements", str(again), "--links-only", "-o", str(back)]) == 1
    assert [row.text for row in read_reqif(back, back.read_text("utf-8"))] == [
        "The part is held.",
        "The arm stops at once.\nAlways.",
    ]
    capsys.readouterr()
    source.write_text("nonsense", encoding="utf-8")
    assert main(["requirements", str(source), "-o", str(again), "--namespace", "https://e.org/", "--force"]) == 2
    assert "this is no XML" in capsys.readouterr().err


CELL = r"<t[hd][^>]*>(.*?)</t[hd]>"


def cells(page: str) -> list[list[str]]:
    """Return the texts of the cells of a page's table."""
    rows = re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)
    return [
        [
            html.unescape(re.sub(r"<[^>]*>", "|", cell)).strip("|")
            for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)
        ]
        for row in rows
    ]


def test_the_page_has_each_requirement_with_its_scenarios(tmp_path: Path) -> None:
    page = tmp_path / "coverage.html"
    main(["requirements", model(tmp_path, NEED + OTHER), "-o", str(page)])
    text = page.read_text(encoding="utf-8")
    found = cells(text)
    assert found[0] == ["Requirement", "Verdict", "fetching.bench-to-tray"]
    assert found[1][1:] == ["not run", "not run"]
    assert found[2] == ['R-2 (4.1/a)||Two|lines; "quoted", and a comma|||spec.pdf §4', "no scenario", ""]
    assert "0 of 2 requirements shown by the last runs" in text
    assert "http" not in text
    main(["requirements", model(tmp_path, NEED + OTHER), "--links-only", "-o", str(page)])
    found = cells(page.read_text(encoding="utf-8"))
    assert [row[1:] for row in found[1:]] == [["verified", "✔"], ["no scenario", ""]]


@pytest.mark.physics
def test_the_page_has_the_verdicts_of_the_last_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = shutil.copytree(EXAMPLES / "rightbin", tmp_path / "rightbin")
    monkeypatch.chdir(folder)
    text = Path("rightbin.bdd").read_text(encoding="utf-8")
    need = 'Requirement (ns=rb) R-1 { "Each part lies in the bin of its colour." }\n\n'
    text = text.replace("Scenario Template", f"{need}Scenario Template", 1)
    text = text.replace("for <part>, after <evt-place-end>)", "for <part>, after <evt-place-end>) verifies <R-1>")
    Path("rightbin.bdd").write_text(text, encoding="utf-8")
    main(["run", "rightbin.bdd", "--json", "run.json"])
    ran: Any = json.loads(Path("run.json").read_text(encoding="utf-8"))
    assert len(ran["scenarios"]) == 3
    assert main(["requirements", "rightbin.bdd", "-o", "coverage.html"]) == 1
    _, row = cells(Path("coverage.html").read_text(encoding="utf-8"))
    assert row[1:] == ["violated", "✔ 2/2", "✗ 0/1"]
