"""Graph models, wherever the command line accepts a model."""

from __future__ import annotations

import json
import subprocess
import threading
from collections.abc import Iterator
from functools import partial
from http.server import HTTPServer, SimpleHTTPRequestHandler
from pathlib import Path

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES

PICKPLACE = EXAMPLES / "pickplace" / "pickplace.bdd"


def robbdd(*arguments: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [*ROBBDD, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=folder)
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("graphs")
    for form, name in (("ttl", "m.ttl"), ("json-ld", "m.json"), ("json-ld", "m.jsonld")):
        (folder / name).write_text(robbdd("graph", PICKPLACE, "--format", form).stdout, encoding="utf-8")
    return folder


def test_graphs_are_checked_like_models(folder: Path) -> None:
    for name in ("m.ttl", "m.json", "m.jsonld"):
        done = robbdd("check", name, folder=folder)
        assert (done.returncode, done.stdout) == (0, "1 file: 0 errors, 0 other remarks\n")


@pytest.mark.parametrize("name", ["m.ttl", "m.json", "m.jsonld"])
def test_a_graph_gives_the_features_and_the_graph_of_its_model(folder: Path, tmp_path: Path, name: str) -> None:
    for path, place in ((PICKPLACE, "text"), (folder / name, "graph")):
        assert robbdd("gherkin", path, "-o", tmp_path / place).returncode == 0
    feature = Path("features", "tidy-bench.feature")
    assert (tmp_path / "graph" / feature).read_bytes() == (tmp_path / "text" / feature).read_bytes()
    assert robbdd("graph", folder / name).stdout == robbdd("graph", PICKPLACE).stdout


@pytest.mark.physics
def test_a_graph_without_prefixes_is_executed_like_its_model(tmp_path: Path) -> None:
    triples = robbdd("graph", PICKPLACE, "--format", "nt").stdout.splitlines(keepends=True)
    (tmp_path / "m.ttl").write_text("".join(line for line in triples if "#prefix>" not in line), encoding="utf-8")
    done = robbdd("run", "m.ttl", "--first", "1", "--no-store", folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "1 scenario: 1 hold" in done.stdout
    assert "✔ cube0 is located at left_ws after evt-place-end" in done.stdout


def test_an_error_in_a_graph_keeps_it_from_becoming_features(folder: Path, tmp_path: Path) -> None:
    text = (folder / "m.ttl").read_text(encoding="utf-8").replace("bdd:of-template", "bdd:of-templat")
    (tmp_path / "wrong.ttl").write_text(text, encoding="utf-8")
    done = robbdd("gherkin", "wrong.ttl", "-o", "features", folder=tmp_path)
    line = text[: text.index("crit:part-to-bin a")].count("\n") + 1
    assert done.returncode == 2
    assert f"wrong.ttl:{line}:1: error: 'crit:part-to-bin': " in done.stderr
    assert not (tmp_path / "features").exists()


def test_a_name_with_another_ending_is_refused_with_the_endings_that_there_are(tmp_path: Path) -> None:
    (tmp_path / "model.owl").touch()
    done = robbdd("check", "model.owl", folder=tmp_path)
    assert done.returncode == 2
    assert "model.owl is not a model: its name must end in one of .bdd, .scene, " in done.stderr
    assert ", .ttl, .json, .jsonld" in done.stderr


def test_a_context_that_may_not_be_fetched_ends_the_command(tmp_path: Path) -> None:
    (tmp_path / "m.json").write_text('{"@context": "https://example.org/c.json"}', encoding="utf-8")
    done = robbdd("check", "m.json", "--allow-host", "example.com", folder=tmp_path)
    assert done.returncode == 2
    assert "robbdd: m.json: the context 'https://example.org/c.json' is not fetched" in done.stderr


@pytest.fixture
def address(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A local server of a context, and a separate cache."""
    (tmp_path / "served").mkdir()
    (tmp_path / "served" / "c.json").write_text('{"@context": {"ex": "https://example.org/"}}', encoding="utf-8")
    monkeypatch.setenv("ROBBDD_CACHE", str(tmp_path / "cache"))
    handler = partial(SimpleHTTPRequestHandler, directory=tmp_path / "served")
    server = HTTPServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    thread.join()
    server.server_close()


def with_context(folder: Path, address: str) -> None:
    model = {"@context": f"{address}/c.json", "@id": "ex:a", "@type": "ex:b"}
    (folder / "m.json").write_text(json.dumps(model), encoding="utf-8")


@pytest.mark.parametrize(
    ("config", "text"),
    [("robbdd.toml", ""), ("pyproject.toml", "[tool.robbdd]\n")],
)
def test_a_folder_cannot_allow_itself_to_use_the_network(
    tmp_path: Path, address: str, config: str, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROBBDD_CONFIG", str(tmp_path / "user" / "robbdd.toml"))
    (tmp_path / config).write_text(f'{text}context-hosts = ["127.0.0.1"]\n', encoding="utf-8")
    with_context(tmp_path, address)
    done = robbdd("check", "m.json", folder=tmp_path)
    line = text.count("\n") + 1
    assert f"{config}:{line}:1: warning: 'context-hosts' is ignored here" in done.stderr
    assert f"'--allow-host HOST', or write the setting into {tmp_path / 'user' / 'robbdd.toml'}" in done.stderr
    assert "is not fetched" in done.stdout
    assert not (tmp_path / "cache").exists()


def test_the_users_own_settings_allow_hosts(tmp_path: Path, address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "user").mkdir()
    (tmp_path / "user" / "robbdd.toml").write_text('context-hosts = ["127.0.0.1"]', encoding="utf-8")
    monkeypatch.setenv("ROBBDD_CONFIG", str(tmp_path / "user" / "robbdd.toml"))
    with_context(tmp_path, address)
    done = robbdd("check", "m.json", folder=tmp_path)
    assert "is not fetched" not in done.stdout + done.stderr
    assert (tmp_path / "cache").exists()


def test_a_wrong_setting_of_hosts_is_reported_at_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "own.toml").write_text('\ncontext-hosts = "a.org"\n', encoding="utf-8")
    monkeypatch.setenv("ROBBDD_CONFIG", str(tmp_path / "own.toml"))
    (tmp_path / "m.json").write_text("{}", encoding="utf-8")
    done = robbdd("check", "m.json", folder=tmp_path)
    assert done.returncode == 2
    assert "own.toml:2:1: error: 'context-hosts' is a list of host names" in done.stderr


@pytest.mark.physics
def test_a_graph_runs_like_its_model(folder: Path) -> None:
    done = robbdd("run", "m.jsonld", folder=folder)
    assert done.returncode == 0, done.stdout
    assert "4 scenarios: 4 hold, 0 violated, 0 unknown" in done.stdout
