"""Bundles of evidence: a true one is valid offline, and each kind of tampering is found."""

from __future__ import annotations

import hashlib
import json
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rdflib import Graph

from commands.test_gherkin import robbdd
from kit import EXAMPLES

pytestmark = pytest.mark.physics
Files = dict[str, bytes]
EDIT = ("is held by <robot>, after <evt-pick-end>", "is held by <robot>, before <evt-pick-end>")


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    """A project with a stored run and its bundle ``true.zip``."""
    request.getfixturevalue("forks")
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path_factory.mktemp("cell") / "cell")
    ran = robbdd("run", "pickplace.bdd", "--first", "2", folder=folder)
    assert ran.returncode == 0, ran.stderr
    packed = robbdd("evidence", "pack", "latest", "-o", "true.zip", folder=folder)
    assert packed.returncode == 0, packed.stderr
    return folder


def read(path: Path) -> Files:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def write(path: Path, files: Files, *, listed: bool) -> None:
    """Write a bundle; with ``listed``, its list of contents has the digests of the files as they are now."""
    if listed:
        contents = json.loads(files["bundle.json"])
        others = {name: data for name, data in files.items() if name != "bundle.json"}
        contents["files"] = {name: hashlib.sha256(data).hexdigest() for name, data in others.items()}
        files = {**files, "bundle.json": json.dumps(contents).encode()}
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)


def changed(files: Files, name: str, change: Callable[[Any], None]) -> Files:
    document = json.loads(files[name])
    change(document)
    return {**files, name: json.dumps(document).encode()}


def verify(cell: Path, name: str, *more: str) -> tuple[int, str]:
    # Elsewhere, so that nothing of the project can help.
    done = robbdd("evidence", "verify", cell / name, *more, folder=cell.parent)
    return done.returncode, done.stdout + done.stderr


def test_a_bundle_is_valid_and_has_the_same_bytes_again(cell: Path) -> None:
    code, said = verify(cell, "true.zip", "--json", "out.json")
    assert code == 0, said
    assert "stated: 2 of 2 executions hold" in said
    assert "verdicts of 2 executions follow from the traces" in said
    assert said.splitlines()[-1] == "valid"
    document = json.loads((cell.parent / "out.json").read_text(encoding="utf-8"))
    assert (document["result"], document["executions"]) == ("valid", 2)
    robbdd("evidence", "pack", "latest", "-o", "again.zip", folder=cell)
    assert (cell / "again.zip").read_bytes() == (cell / "true.zip").read_bytes()
    assert verify(cell, "true.zip", "--digest", document["digest"])[0] == 0
    code, said = verify(cell, "true.zip", "--digest", "0" * 64)
    assert (code, "the digest of the bundle is" in said) == (1, True)


def test_the_graph_leads_from_a_clause_to_the_trace(cell: Path) -> None:
    graph = Graph().parse(data=read(cell / "true.zip")["graph.ttl"], format="turtle")
    found = graph.query(
        """PREFIX earl: <http://www.w3.org/ns/earl#> PREFIX prov: <http://www.w3.org/ns/prov#>
        SELECT DISTINCT ?trace WHERE {
            ?assertion earl:test ?clause; earl:result/earl:outcome earl:passed; prov:wasGeneratedBy ?run .
            ?trace prov:wasGeneratedBy ?run . FILTER(strstarts(str(?trace), "ni:///sha-256;")) }"""
    )
    assert len(list(found)) == 2


def test_a_changed_missing_or_added_file_is_named(cell: Path) -> None:
    files = read(cell / "true.zip")
    results = files["run/results.json"].replace(b'"holds"', b'"violated"', 1)
    write(cell / "changed.zip", {**files, "run/results.json": results}, listed=False)
    assert verify(cell, "changed.zip") == (1, verify(cell, "changed.zip")[1])
    assert "run/results.json was changed" in verify(cell, "changed.zip")[1]
    write(cell / "less.zip", {name: data for name, data in files.items() if name != "graph.ttl"}, listed=False)
    assert "graph.ttl is missing" in verify(cell, "less.zip")[1]
    write(cell / "more.zip", {**files, "sources/other.bdd": b""}, listed=False)
    assert "sources/other.bdd is not listed" in verify(cell, "more.zip")[1]


def violate(document: Any) -> None:
    document["scenarios"][0]["verdict"] = "violated"
    for clause in document["scenarios"][0]["clauses"]:
        clause["verdict"] = "violated"


def better(document: Any) -> None:
    clause = next(one for one in document["scenarios"][1]["clauses"] if one["unit"] == "m")
    clause["robustness"] += 0.01


def other_total(document: Any) -> None:
    document["scenarios"][0]["verdict"] = "violated"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (violate, "stated is violated ("),
        (better, ", and the trace gives holds ("),
        (other_total, "stated is violated, and its clauses give holds"),
    ],
)
def test_verdicts_that_do_not_follow_from_the_traces_are_found(
    cell: Path, change: Callable[[Any], None], message: str
) -> None:
    """The digests of all files were computed again, so only the contents can contradict each other."""
    write(cell / "forged.zip", changed(read(cell / "true.zip"), "run/results.json", change), listed=True)
    code, said = verify(cell, "forged.zip")
    assert (code, message in said) == (1, True), said
    assert "graph.ttl is not the graph of the model with these results" in said


def test_swapped_traces_and_a_changed_requirement_are_found(cell: Path) -> None:
    files = read(cell / "true.zip")
    one, other = "run/traces/000000.mcap", "run/traces/000001.mcap"
    write(cell / "swapped.zip", {**files, one: files[other], other: files[one]}, listed=True)
    code, said = verify(cell, "swapped.zip")
    assert (code, "the trace gives" in said) == (1, True), said
    (model,) = [name for name in files if name.endswith("pickplace.bdd")]
    text = files[model].decode().replace(*EDIT)
    assert text.encode() != files[model]
    write(cell / "model.zip", {**files, model: text.encode()}, listed=True)
    code, said = verify(cell, "model.zip")
    assert (code, "the digest of the model's graph is" in said) == (1, True), said


def test_a_bundle_without_traces_is_not_contradicted_but_not_checked_in_full(cell: Path) -> None:
    robbdd("evidence", "pack", "latest", "--no-traces", "-o", "small.zip", folder=cell)
    code, said = verify(cell, "small.zip")
    assert code == 3, said
    assert "the bundle has no traces, so no verdict was judged again" in said


@pytest.mark.parametrize("name", ["../out.txt", "/out.txt", "a/../../out.txt", "c:\\out.txt"])
def test_a_hostile_name_writes_nothing_outside(cell: Path, name: str) -> None:
    write(cell / "hostile.zip", {**read(cell / "true.zip"), name: b"x"}, listed=True)
    code, said = verify(cell, "hostile.zip")
    assert (code, "is no name of a file in a bundle" in said) == (1, True), said


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"text", "is not a bundle of evidence, or it is damaged"),
        ({"a.txt": b""}, "it has no bundle.json"),
        ({"bundle.json": b"{"}, "bundle.json is not JSON"),
        ({"bundle.json": b"[]"}, "bundle.json is not an object"),
        ({"bundle.json": b'{"format": 9}'}, "has the format 9, and this RobBDD reads 1"),
        ({"bundle.json": b'{"format": 1, "files": [1]}'}, "does not list files with their digests"),
    ],
)
def test_another_file_is_explained(cell: Path, content: bytes | Files, message: str) -> None:
    if isinstance(content, bytes):
        (cell / "other.zip").write_bytes(content)
    else:
        write(cell / "other.zip", content, listed=False)
    code, said = verify(cell, "other.zip")
    assert (code, message in said) == (2, True), said


def test_a_changed_model_or_an_unknown_run_is_not_packed(cell: Path) -> None:
    copy = shutil.copytree(cell, cell.parent / "copy")
    path = copy / "pickplace.bdd"
    path.write_text(path.read_text(encoding="utf-8").replace(*EDIT), encoding="utf-8")
    done = robbdd("evidence", "pack", "latest", "-o", "out.zip", folder=copy)
    assert (done.returncode, "was changed since the run" in done.stderr) == (2, True), done.stderr
    done = robbdd("evidence", "pack", "77", "-o", "out.zip", folder=copy)
    assert (done.returncode, "there is no run '77'" in done.stderr) == (2, True)
    assert not (copy / "out.zip").exists()


def test_users_code_in_a_bundle_is_executed_only_on_demand(cell: Path) -> None:
    robbdd("run", "pickplace.bddx", "--first", "1", folder=cell)
    robbdd("evidence", "pack", "latest", "-o", "code.zip", folder=cell)
    code, said = verify(cell, "code.zip")
    assert (code, "which --user-code executes if you trust it" in said) == (3, True), said
    assert verify(cell, "code.zip", "--user-code")[0] == 0
