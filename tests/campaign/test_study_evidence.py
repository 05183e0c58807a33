"""Bundles of studies: a true one is valid offline, and each kind of tampering is found."""

from __future__ import annotations

import hashlib
import json
import shutil
import zipfile
from base64 import urlsafe_b64encode
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rdflib import Graph

from campaign.study_agents import QuickAgent, write_study
from robbdd_tools.campaign import study_evidence_graph
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler

Files = dict[str, bytes]
RESULTS = "study/results.json"
VERDICTS = """
PREFIX earl: <http://www.w3.org/ns/earl#>
PREFIX prov: <http://www.w3.org/ns/prov#>
PREFIX rbw: <https://robbdd.org/metamodels/workbench#>
SELECT ?clause ?outcome ?execution ?trace WHERE {
    ?execution a rbw:ScenarioRun ; rbw:run/prov:used ?study . ?study a rbw:Study ; rbw:of-variant ?variant .
    ?execution rbw:of-variant ?variant .
    ?assertion earl:test ?clause; earl:result/earl:outcome ?outcome; prov:wasGeneratedBy ?execution .
    OPTIONAL { ?trace prov:wasGeneratedBy ?execution ; a prov:Entity . FILTER STRSTARTS(STR(?trace), "ni:") }
}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the bundle ``true.zip`` of a study, and nothing of the study itself."""
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    project = tmp_path / "project"
    study = write_study(project)
    monkeypatch.chdir(project)
    assert main(["study", "run", study.name]) == 1
    assert main(["evidence", "pack", study.name, "-o", "../true.zip"]) == 0
    assert main(["evidence", "pack", study.name, "-o", "../again.zip"]) == 0
    monkeypatch.chdir(tmp_path)
    shutil.rmtree(project)
    return tmp_path


def read(path: Path) -> Files:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def verified(
    folder: Path, files: Files, capsys: pytest.CaptureFixture[str], *options: str, listed: bool = True
) -> tuple[int, str]:
    """Write a bundle, with ``listed`` also the digests of its files as they are now, and verify it."""
    if listed:
        contents = json.loads(files["bundle.json"])
        others = {name: data for name, data in files.items() if name != "bundle.json"}
        contents["files"] = {name: hashlib.sha256(data).hexdigest() for name, data in others.items()}
        files = {**files, "bundle.json": json.dumps(contents).encode()}
    with zipfile.ZipFile(folder / "other.zip", "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    capsys.readouterr()
    code = main(["evidence", "verify", "other.zip", *options])
    return code, capsys.readouterr().out


def changed(files: Files, change: Callable[[dict[str, Any]], None]) -> Files:
    """Change the results, and leave out the graph, which would show any change."""
    document = json.loads(files[RESULTS])
    change(document)
    others = {name: data for name, data in files.items() if name != "graph.ttl"}
    return {**others, RESULTS: json.dumps(document).encode()}


def test_a_bundle_is_valid_without_the_project_and_has_the_same_bytes_again(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (folder / "true.zip").read_bytes() == (folder / "again.zip").read_bytes()
    digest = hashlib.sha256(read(folder / "true.zip")["bundle.json"]).hexdigest()
    capsys.readouterr()
    assert main(["evidence", "verify", "true.zip", "--replay", "5", "--digest", digest]) == 0
    said = capsys.readouterr().out
    assert "40 of 40 executions are those that the study plans, with their seeds" in said
    assert "5 of 40 executions, executed again, have the same verdicts and margins" in said
    assert said.splitlines()[-1] == "valid"
    assert main(["evidence", "verify", "true.zip"]) == 3
    assert "--replay N executes N of them" in capsys.readouterr().out
    assert main(["evidence", "verify", "true.zip", "--digest", "0" * 64]) == 1


def test_a_changed_file_is_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = read(folder / "true.zip")
    other = {**files, "sources/m.bdd": files["sources/m.bdd"].replace(b"0.5 seconds", b"0.4 seconds")}
    assert other != files
    code, said = verified(folder, other, capsys, listed=False)
    assert (code, "sources/m.bdd was changed" in said) == (1, True)
    code, said = verified(folder, other, capsys)
    assert (code, "the digest of the study is" in said) == (1, True)
    less = {name: data for name, data in files.items() if name != RESULTS}
    assert "study/results.json is missing" in verified(folder, less, capsys, listed=False)[1]


def first_violation(document: dict[str, Any]) -> int:
    return next(number for number, row in enumerate(document["execution"]) if row[5] == 1)


def total_alone(document: dict[str, Any]) -> None:
    document["execution"][first_violation(document)][5] = 0


def whole_verdict(document: dict[str, Any]) -> None:
    row = document["execution"][first_violation(document)]
    row[5] = 0
    for clause in document["clause"]:
        if clause[0] == row[0]:
            clause[3] = 0


def margin(document: dict[str, Any]) -> None:
    document["clause"][0][4] += 0.01


def seed(document: dict[str, Any]) -> None:
    document["execution"][3][4] += 1


def removed(document: dict[str, Any]) -> None:
    number = document["execution"].pop(first_violation(document))[0]
    document["clause"] = [one for one in document["clause"] if one[0] != number]


def odd_row(document: dict[str, Any]) -> None:
    document["execution"].append([1])


def no_clauses(document: dict[str, Any]) -> None:
    del document["clause"]


def cut(document: dict[str, Any]) -> None:
    last = document["execution"].pop()[0]
    document["clause"] = [one for one in document["clause"] if one[0] != last]


@pytest.mark.parametrize(
    ("change", "code", "message"),
    [
        (total_alone, 1, "its clauses give violated"),
        (whole_verdict, 1, "was holds, and is violated"),
        (margin, 1, "the margin of on-bench was"),
        (seed, 1, "is not planned"),
        (removed, 1, "is missing, and later ones are stored"),
        (cut, 3, "1 of 40 planned executions have no result"),
        (odd_row, 1, "study/results.json cannot be used"),
        (no_clauses, 1, "study/results.json cannot be used"),
    ],
)
def test_tampering_with_results_is_found(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    change: Callable[[dict[str, Any]], None],
    code: int,
    message: str,
) -> None:
    found, said = verified(folder, changed(read(folder / "true.zip"), change), capsys, "--replay", "40")
    assert (found, message in said) == (code, True), said


def test_a_study_that_was_edited_is_not_packed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    study = write_study(tmp_path)
    assert main(["study", "run", study.name]) == 1
    study.write_text(study.read_text(encoding="utf-8").replace("seed: 3", "seed: 4"), encoding="utf-8")
    assert main(["evidence", "pack", study.name, "-o", "x.zip"]) == 2
    assert "was changed since it began" in capsys.readouterr().err
    assert not Path("x.zip").exists()


@pytest.fixture
def traced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a study that has kept the trace of its third execution. It is the working folder."""
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    assert main(["study", "run", write_study(tmp_path).name]) == 1
    trace = tmp_path / ".robbdd/studies/x.study/traces/3.mcap"
    trace.parent.mkdir()
    trace.write_bytes(b"poses")
    return tmp_path


def test_the_graph_leads_from_the_study_over_clauses_and_executions_to_traces(traced: Path) -> None:
    assert main(["evidence", "pack", "x.study", "-o", "x.zip"]) == 0
    files = read(traced / "x.zip")
    assert files["study/traces/3.mcap"] == b"poses"
    found: Any = list(Graph().parse(data=files["graph.ttl"], format="turtle").query(VERDICTS))
    stated = json.loads(files[RESULTS])
    assert len({row.execution for row in found}) == 40
    assert len(found) == len(stated["clause"])
    violated = [row for row in found if str(row.outcome).endswith("failed")]
    assert len(violated) == sum(clause[3] == 1 for clause in stated["clause"])
    # RFC 6920: the digest in base64url without padding.
    name = urlsafe_b64encode(hashlib.sha256(b"poses").digest()).decode().rstrip("=")
    named = {(str(row.trace), str(row.execution).rpartition("/")[2]) for row in found if row.trace is not None}
    assert named == {(f"ni:///sha-256;{name}", "3")}


def test_a_changed_trace_or_graph_contradicts_the_rest(traced: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evidence", "pack", "x.study", "-o", "x.zip"]) == 0
    files = read(traced / "x.zip")
    code, said = verified(traced, files, capsys)
    assert (code, "✔ graph: graph.ttl is that of the study, its results and its traces" in said) == (3, True), said
    for other in ({"study/traces/3.mcap": b"others"}, {"graph.ttl": files["graph.ttl"].replace(b"failed", b"passed")}):
        code, said = verified(traced, {**files, **other}, capsys)
        assert (code, "graph.ttl is not the graph of the study with these results" in said) == (1, True), said
    assert (
        "study/traces/3.mcap was changed"
        in verified(traced, {**files, "study/traces/3.mcap": b""}, capsys, listed=False)[1]
    )


def test_a_bundle_without_its_traces_or_of_too_many_executions_has_no_graph(
    traced: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["evidence", "pack", "x.study", "-o", "x.zip", "--no-traces"]) == 0
    assert not {"graph.ttl", "study/traces/3.mcap"} & read(traced / "x.zip").keys()
    monkeypatch.setattr(study_evidence_graph, "MOST_EXECUTIONS", 39)
    assert main(["evidence", "pack", "x.study", "-o", "y.zip"]) == 0
    files = read(traced / "y.zip")
    assert ("graph.ttl" in files, "study/traces/3.mcap" in files) == (False, True)
