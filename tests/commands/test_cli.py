"""The command line as scripts use it: exit codes, text, JSON."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, MODEL, SCENE, corpus, default_signals, make_endless, schema_errors
from robbdd_tools.commands.run import Outputs, report_problems

PICKPLACE = EXAMPLES / "pickplace" / "pickplace.bdd"


def robbdd(*arguments: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([*ROBBDD, *map(str, arguments)], capture_output=True, encoding="utf-8", cwd=folder)
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "main.bdd").write_text(MODEL, encoding="utf-8")
    (tmp_path / "lab.scene").write_text(SCENE.replace("bolt", "cube0").replace("nut", "cube1"), encoding="utf-8")
    return tmp_path


def test_a_sound_folder_has_no_error(folder: Path) -> None:
    done = robbdd("check", ".", folder=folder)
    *remarks, summary = done.stdout.splitlines()
    assert (done.returncode, summary) == (0, "2 files: 0 errors, 1 other remark")
    assert [remark.rpartition(" ")[2] for remark in remarks] == ["[catalog-models]"]


def test_every_example_is_clean() -> None:
    *remarks, summary = robbdd("check", EXAMPLES).stdout.splitlines()
    assert ": 0 errors, " in summary
    assert {remark.rpartition(" ")[2] for remark in remarks} == {"[catalog-models]"}


def test_a_model_above_the_working_folder_is_looked_at_once(folder: Path) -> None:
    (folder / "below").mkdir()
    shown = robbdd("check", "..", folder=folder / "below").stdout.splitlines()
    assert [line.rpartition(" ")[2] for line in shown] == ["[catalog-models]", "remark"]
    assert shown[-1] == "2 files: 0 errors, 1 other remark"


def test_a_folder_is_read_without_what_is_installed_in_it(folder: Path) -> None:
    for name in (".robbdd", "node_modules", "venv"):
        (folder / name / "inner").mkdir(parents=True)
        (folder / name / "inner" / "broken.bdd").write_text("nonsense", encoding="utf-8")
    (folder / "venv" / "pyvenv.cfg").touch()
    (folder / "deeper").mkdir()
    (folder / "deeper" / "other.scene").write_text(SCENE, encoding="utf-8")
    assert "3 files: 0 errors" in robbdd("check", folder).stdout


def test_an_error_is_shown_with_its_place_and_code(folder: Path) -> None:
    (folder / "main.bdd").write_text(MODEL.replace("<bench_scene>", "<bench-scene>"), encoding="utf-8")
    done = robbdd("check", "main.bdd", folder=folder)
    line = MODEL[: MODEL.index("<bench_scene>")].count("\n") + 1
    assert done.returncode == 1
    assert (
        f"main.bdd:{line}:21: error: there is no scene 'bench-scene'; did you mean 'bench_scene'? [unknown-name]"
        in (done.stdout)
    )


@pytest.mark.parametrize(("mark", "end"), [(b"", "\n"), (b"\xef\xbb\xbf", "\r\n")])
def test_places_are_right_whatever_the_form_of_the_file(folder: Path, mark: bytes, end: str) -> None:
    text = MODEL.replace("    ", "\t").replace('As A "operator"', 'As A "größer 部品 🤖"')
    text = text.replace("Event (ns=t) start", "Event (ns=t) größe-部品\nEvent (ns=t) start")
    text = text.replace("scene: <bench_scene>", "scene: <bench-scene>").replace(
        "before <pick-start>", "before <größe-部>"
    )
    text = text.replace('So That "work', 'So Thot "work').rstrip()
    (folder / "main.bdd").write_bytes(mark + text.replace("\n", end).encode())
    shown = robbdd("check", "main.bdd", folder=folder).stdout.splitlines()
    found = [line.split(": ")[0] for line in shown if ": error: " in line]
    lines = text.split("\n")
    expected = [
        f"main.bdd:{number}:{line.index(word) + 1}"
        for number, line in enumerate(lines, start=1)
        for word in ("größe-部>", "Thot", "bench-scene>")
        if word in line
    ]
    assert found == expected
    assert len(found) == 3


def test_diagnostics_as_json_follow_their_schema(folder: Path) -> None:
    (folder / "main.bdd").write_text(MODEL + "Event (ns=t) end\nEvnt\n", encoding="utf-8")
    done = robbdd("check", "--json", "main.bdd", folder=folder)
    entries = [json.loads(line) for line in done.stdout.splitlines()]
    assert [schema_errors("diagnostic.schema.json", entry) for entry in entries] == [[]] * len(entries)
    assert sorted(entry["code"] for entry in entries) == ["catalog-models", "duplicate-name", "syntax"]
    assert entries[0]["related"][0]["file"] == "main.bdd"


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("missing.bdd", None, "there is no file 'missing.bdd'"),
        ("binary.bdd", b"\0\1", "is a binary file"),
        ("latin.bdd", b"ns a = '\xff'", "is not UTF-8"),
        # A test's name goes into its environment, which older versions of pytest do not shorten.
        pytest.param("huge.bdd", b"a" * 10 * 1024 * 1024, "split the model", id="huge"),
        ("notes.txt", b"hello", "its name must end in one of .bdd, .scene, .scenex, .ktree, .bddx, .ttl"),
        ("notes", None, "there is no file or folder notes"),
    ],
)
@pytest.mark.parametrize("command", ["check", "run", "graph"])
def test_what_is_no_model_ends_with_2_and_its_reason(
    tmp_path: Path, command: str, name: str, data: bytes | None, words: str
) -> None:
    if data is not None:
        (tmp_path / name).write_bytes(data)
    done = robbdd(command, name, folder=tmp_path)
    assert done.returncode == 2
    assert words in done.stdout + done.stderr


@pytest.mark.parametrize("text", ["", "ns t = 'https://x/'\nEvent (ns=t) e\n"])
def test_a_model_without_a_scenario_cannot_run(tmp_path: Path, text: str) -> None:
    (tmp_path / "m.bdd").write_text(text, encoding="utf-8")
    done = robbdd("run", "m.bdd", folder=tmp_path)
    assert (done.returncode, done.stderr) == (2, "m.bdd:1:1: error: the model has no scenario to run [no-scenario]\n")
    assert robbdd("check", "m.bdd", folder=tmp_path).returncode == 0


def test_an_import_of_itself_is_an_error_at_its_place(tmp_path: Path) -> None:
    (tmp_path / "self.bdd").write_text('import "self.bdd"\n', encoding="utf-8")
    done = robbdd("run", "self.bdd", folder=tmp_path)
    assert (done.returncode, done.stderr) == (
        2,
        "self.bdd:1:9: error: the file imports itself: remove this import [import]\n",
    )


@pytest.mark.parametrize("form", ["ttl", "json-ld", "nt", "xml"])
def test_a_graph_is_printed_in_each_form(folder: Path, form: str) -> None:
    done = robbdd("graph", "main.bdd", "--format", form, folder=folder)
    assert done.returncode == 0
    assert "UserStory" in done.stdout


def test_format_rewrites_what_is_not_in_canonical_layout(folder: Path) -> None:
    (folder / "messy.scene").write_text("ns  e   = 'urn:x:'", encoding="utf-8")
    assert robbdd("format", "--check", "messy.scene", folder=folder).returncode == 1
    assert robbdd("format", "messy.scene", folder=folder).returncode == 0
    assert (folder / "messy.scene").read_text(encoding="utf-8") == "ns e = 'urn:x:'\n"
    done = robbdd("format", "--check", "messy.scene", folder=folder)
    assert (done.returncode, done.stdout) == (0, "0 of 1 files would change\n")


def test_an_unknown_scenario_is_answered_with_the_known_ones(folder: Path) -> None:
    done = robbdd("run", "main.bdd", "--scenario", "nope", folder=folder)
    assert (done.returncode, done.stderr) == (2, "robbdd: there is no scenario 'nope'; the model has bench-to-tray\n")


def test_a_report_that_cannot_be_written_is_refused_before_the_run(folder: Path) -> None:
    done = robbdd("run", "main.bdd", "--json", "no/such/out.json", folder=folder)
    assert done.returncode == 2
    assert "there is no folder" in done.stderr


@pytest.mark.physics
def test_the_demo_holds_clause_by_clause(tmp_path: Path) -> None:
    report = tmp_path / "out.json"
    done = robbdd("run", PICKPLACE, "--json", report, "--no-store")
    assert done.returncode == 0, done.stdout
    assert "✔ cube0 is located at left_ws after evt-place-end" in done.stdout
    assert "4 scenarios: 4 hold, 0 violated, 0 unknown  (seed 1;" in done.stdout
    document = json.loads(report.read_text(encoding="utf-8"))
    assert schema_errors("run.schema.json", document) == []
    assert [scenario["variation"] for scenario in document["scenarios"]] == [1, 2, 3, 4]


@pytest.mark.physics
def test_a_clause_that_physics_contradicts_is_violated(tmp_path: Path) -> None:
    shutil.copy(PICKPLACE.with_name("bench.scene"), tmp_path)
    text = PICKPLACE.read_text(encoding="utf-8").replace("<cubes.cube0>, <balls.ball0>", "<cubes.cube0>")
    wrong = text.replace("<goal>, after <evt-place-end>", "<goal>, before <evt-pick-start>")
    (tmp_path / "m.bdd").write_text(wrong, encoding="utf-8")
    done = robbdd("run", "m.bdd", folder=tmp_path)
    assert done.returncode == 1
    assert "✗ cube0 is located at left_ws before evt-pick-start" in done.stdout


@pytest.mark.physics
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no POSIX signals")
def test_ctrl_c_keeps_what_is_finished(tmp_path: Path) -> None:
    shutil.copytree(PICKPLACE.parent, tmp_path / "pickplace")
    model, report = tmp_path / "pickplace" / PICKPLACE.name, tmp_path / "out.json"
    make_endless(model)
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    # Not a fork: how a real interpreter takes the signal is tested.
    command = [sys.executable, "-m", "robbdd_tools.cli", "run", model, "--json", report, "--jobs", "1", "--no-store"]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, encoding="utf-8", env=environment, preexec_fn=default_signals
    )
    assert process.stdout is not None
    while "part-to-bin -- 1" not in process.stdout.readline():
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    rest = process.stdout.read()
    assert process.wait() == 130
    assert "the run is incomplete: the run was interrupted" in rest
    document = json.loads(report.read_text(encoding="utf-8"))
    assert document["complete"] is False
    assert document["scenarios"][0]["verdict"] == "holds"
    assert schema_errors("run.schema.json", document) == []


def test_foreign_models_pass_the_check() -> None:
    files = corpus(".bdd", ".scene")
    done = robbdd("check", *files)
    assert done.returncode == 0, done.stdout


def test_a_closed_pipe_is_no_problem_of_the_command() -> None:
    def work() -> int:
        raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        report_problems(Outputs(), viewer=False, work=work)
