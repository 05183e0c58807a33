"""``robbdd doctor`` finds out what works, and each fault is reported with its fix."""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

from kit import schema_errors
from robbdd_tools import __version__, cli
from robbdd_tools.base.processes import Ending
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.cli import main
from robbdd_tools.commands import doctor, installation, selftest
from robbdd_tools.commands.doctor import Part, State, examine
from robbdd_tools.run.database import MIGRATIONS
from robbdd_tools.run.store import FOLDER, RunStore

DOCTOR = [sys.executable, "-m", "robbdd_tools.cli", "doctor"]
CAREFUL = [
    *("package", "python", "system", "libraries", "catalog", "models", "shapes", "features", "simulation", "server"),
    "store",
]
"""Parts that must work wherever the tests run."""


@pytest.mark.physics
def test_all_parts_of_this_installation_work(tmp_path: Path) -> None:
    done = subprocess.run([*DOCTOR, "--json", tmp_path], capture_output=True, encoding="utf-8", check=False)
    answer = json.loads(done.stdout)
    assert schema_errors("doctor.schema.json", answer) == []
    parts = {part["name"]: part for part in answer["parts"]}
    assert {name: parts[name]["detail"] for name in CAREFUL if parts[name]["state"] != "works"} == {}
    assert (done.returncode, done.stderr, answer["healthy"]) == (0, "", True)
    assert __version__ in parts["package"]["detail"]
    assert {"rdflib", "mujoco", "behave", "textx"} <= {
        entry.split()[0].lower() for entry in parts["libraries"]["detail"].split(", ")
    }
    assert parts["simulation"]["detail"].startswith("MuJoCo ")
    assert list(tmp_path.iterdir()) == [], "nothing is left in the project"


@pytest.fixture
def only(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Keep the parts that a test is about."""

    def keep(**tests: Callable[[], str]) -> None:
        monkeypatch.setattr(installation, "TESTS", tests)
        monkeypatch.setattr(selftest, "TESTS", {})

    return keep


def broken() -> str:
    raise ZeroDivisionError("division by zero")


def test_a_part_that_breaks_is_reported_and_the_others_are_tested(
    only: Callable[..., None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    only(bad=broken, good=lambda: "all well")
    assert main(["doctor", str(tmp_path)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "✗ bad         ZeroDivisionError: division by zero",
        f"              Fix: {doctor.REPORT}",
        "✔ good        all well",
        f"✔ store       {tmp_path / '.robbdd' / 'runs'}: 0 runs, writable",
    ]


def test_words_of_packages_that_are_left_out_are_a_failed_part(
    only: Callable[..., None], monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = load_catalog()
    assert f"{len(whole.predicates)} predicates" in installation.words()
    monkeypatch.setattr(installation, "load_catalog", lambda: replace(whole, problems=("'a' is left out: b",)))
    only(catalog=installation.words)
    assert main(["doctor", str(tmp_path)]) == 1
    assert capsys.readouterr().out.splitlines()[:2] == [
        "✗ catalog     'a' is left out: b",
        "              Fix: update or uninstall the packages that are named",
    ]


def test_words_of_packages_that_are_left_out_are_named_after_a_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(cli, "problems_of_words", lambda: ("'a' is left out: \x1b[2J",))
    (tmp_path / "lab.scene").write_text("", encoding="utf-8")
    assert main(["check", str(tmp_path)]) == 0
    assert capsys.readouterr().err == "robbdd: 'a' is left out: \\x1b[2J\n"


def test_what_others_named_is_printed_escaped(
    only: Callable[..., None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    only(package=lambda: "in /home/\x1b[31mred/\u202e")
    assert main(["doctor", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[0] == r"✔ package     in /home/\x1b[31mred/\u202e"
    assert main(["doctor", "--json", str(tmp_path)]) == 0
    written = capsys.readouterr().out
    assert written.replace("\n", "").isprintable()
    assert json.loads(written)["parts"][0]["detail"] == "in /home/\x1b[31mred/\u202e"


def test_an_optional_part_that_is_missing_does_not_fail_the_command(
    only: Callable[..., None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing() -> str:
        raise installation.Unavailable("not here\nnor there", "install it", optional=True)

    only(extra=missing)
    assert main(["doctor", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[:3] == [
        "– extra       not here",
        "              nor there",
        "              Fix: install it",
    ]


@pytest.mark.parametrize(
    ("test", "gone", "state"), [("libraries", "mujoco", "failed"), ("extras", "pillow", "missing")]
)
def test_a_library_that_is_not_installed_is_named_with_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch, test: str, gone: str, state: str
) -> None:
    real = metadata.version

    def version(name: str) -> str:
        if name == gone:
            raise metadata.PackageNotFoundError(name)
        return real(name)

    monkeypatch.setattr(metadata, "version", version)
    part = examine(test, installation.TESTS[test])
    assert (part.state, gone in part.detail) == (state, True)
    assert part.fix.startswith("python -m pip install ")


def test_the_extension_must_be_of_the_same_version(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    assert examine("editor", installation.editor).state is State.MISSING
    folder = tmp_path / ".vscode" / "extensions" / f"{installation.EXTENSION}-9.9.9"
    folder.mkdir(parents=True)
    manifest = folder / "package.json"
    for content, state in (("{", State.MISSING), ('{"version": "9.9.9"}', State.MISSING)):
        manifest.write_text(content, encoding="utf-8")
        part = examine("editor", installation.editor)
        assert (part.state, f"version {__version__}" in part.fix) == (state, True)
    manifest.write_text(json.dumps({"version": __version__}), encoding="utf-8")
    assert examine("editor", installation.editor).state is State.WORKS


ENDINGS = {
    "models": Ending(1, "", "main.bdd:1:1: error: broken [syntax]\n"),
    "shapes": Ending(0, "1 file: 0 errors, 0 other remarks\n", ""),
    "features": Ending(0, "", ""),
    "simulation": Ending(-11, "", ""),
    "server": Ending(None, "", ""),
}


@pytest.mark.parametrize("name", ENDINGS)
def test_a_command_that_fails_dies_or_hangs_is_a_failed_part(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, name: str
) -> None:
    def ends(*_: Any, **__: Any) -> Ending:
        return ENDINGS[name]

    monkeypatch.setattr(selftest, "run_for", ends)
    part = examine(name, lambda: selftest.TESTS[name](tmp_path / "project"))
    assert part.state is State.FAILED
    assert part.fix.startswith("python -m pip install ")
    last_words = {"models": "broken [syntax] (code 1)", "simulation": "signal SIGSEGV", "server": "ended after 120 s"}
    assert last_words.get(name, "(code 0)" if name == "shapes" else "code 0") in part.detail


def test_without_a_back_end_there_are_no_pictures_and_the_fix_is_said(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "nonsense")
    selftest.models(tmp_path / "project")
    part = examine("rendering", lambda: selftest.rendering(tmp_path / "project"))
    assert part.state is State.MISSING
    assert part.detail.startswith("nonsense: ")
    assert "install " in part.fix


def test_a_file_in_the_place_of_the_store_is_found(tmp_path: Path) -> None:
    (tmp_path / ".robbdd").write_text("in the way", encoding="utf-8")
    part = examine("store", lambda: selftest.store(tmp_path))
    assert (part.state, "cannot be written" in part.detail) == (State.FAILED, True)


def test_a_store_with_a_run_that_cannot_be_read_is_found(tmp_path: Path) -> None:
    (tmp_path / ".robbdd" / "runs" / "3").mkdir(parents=True)
    part = examine("store", lambda: selftest.store(tmp_path))
    assert (part.state, f"runs{os.sep}3" in part.detail) == (State.FAILED, True)


@pytest.fixture
def database(tmp_path: Path) -> Path:
    """The database of a project that has no runs, with some executions."""
    store = RunStore(tmp_path / FOLDER)
    store.begin().discard()
    with closing(sqlite3.connect(store.database)) as connection:
        connection.executemany(
            """INSERT INTO execution (id, run, idx, key, story, variant, variation, repetition, seed, verdict,
                simulated, resampled, wall, stepping, host, ended)
            VALUES (?, 2, ?, '', '', '', 0, 1, 1, 'holds', 1, 0, 1, 1, '', '')""",
            [(number, number) for number in range(1, 10)],
        )
        connection.commit()
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return store.database


def stored(folder: Path) -> Part:
    return examine("store", lambda: selftest.store(folder))


def test_the_database_of_results_is_checked_and_left_as_it_is(database: Path, tmp_path: Path) -> None:
    before = database.read_bytes()
    part = stored(tmp_path)
    assert (part.state, part.fix) == (State.WORKS, "")
    assert part.detail.endswith(
        f"0 runs, writable; results.sqlite: schema {len(MIGRATIONS)}, integrity checked, writable"
    )
    assert database.read_bytes() == before


def test_an_index_that_lacks_rows_of_its_table_is_found(database: Path, tmp_path: Path) -> None:
    query = "SELECT rootpage FROM sqlite_master WHERE name LIKE 'sqlite_autoindex_execution%'"
    with closing(sqlite3.connect(database)) as connection:
        (page,) = connection.execute(query).fetchone()
        (size,) = connection.execute("PRAGMA page_size").fetchone()
    data = bytearray(database.read_bytes())
    cells = (page - 1) * size + 3
    assert data[cells : cells + 2] == bytes([0, 9])
    data[cells : cells + 2] = bytes([0, 8])
    database.write_bytes(data)
    part = stored(tmp_path)
    assert (part.state, "results.sqlite: is damaged: " in part.detail) == (State.FAILED, True)
    assert part.fix.startswith("move it away: the next run begins a new one")


def test_a_database_of_a_newer_version_or_of_something_else_is_reported(database: Path, tmp_path: Path) -> None:
    with closing(sqlite3.connect(database)) as connection:
        connection.execute("PRAGMA user_version = 999")
    part = stored(tmp_path)
    assert (part.state, f"(schema 999; this one knows {len(MIGRATIONS)}): update RobBDD" in part.detail) == (
        State.FAILED,
        True,
    )
    database.unlink()
    database.mkdir()
    assert stored(tmp_path).state is State.FAILED


@pytest.mark.usefixtures("database")
def test_a_database_that_cannot_be_written_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    connect = sqlite3.connect

    def read_only(name: str, *arguments: Any, **options: Any) -> sqlite3.Connection:
        return connect(name.replace("mode=rw", "mode=ro"), *arguments, **options)

    monkeypatch.setattr(sqlite3, "connect", read_only)
    part = stored(tmp_path)
    assert (part.state, "attempt to write a readonly database" in part.detail) == (State.FAILED, True)
    assert part.fix == "name another store with `--store DIR`"


def test_an_installation_without_its_data_is_no_traceback(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def missing(folder: Path, template: str) -> None:
        raise FileNotFoundError(f"the installation of robbdd-tools lacks its folder {template} ({folder.name})")

    monkeypatch.setattr(selftest, "begin_project", missing)
    part = examine("models", lambda: selftest.models(tmp_path / "project"))
    assert part == Part("models", State.FAILED, part.detail, doctor.REPORT)
    assert "lacks its folder pickplace" in part.detail
