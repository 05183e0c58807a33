"""No module in the models' folder is imported instead of an intended one."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient, client_capabilities, make_test_lsp_client

from kit import command_names
from lsp_kit import ASKED, PATIENCE
from planting_kit import HostileFolder, importable_names, write_ranged_study
from robbdd_tools import __version__
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.isolation import EXPOSED
from world.hollow import write_tote

SCRIPTS = Path(sysconfig.get_path("scripts"))
COMMANDS = (
    "completion bash",
    "check .",
    "format --check .",
    "gherkin pickplace.bdd -o out/features",
    "graph pickplace.bddx",
    "steps pickplace.bdd",
    "query pickplace.bdd --name variants",
    "view pickplace.bdd -o out/scene.png",
    "run pickplace.bddx --first 1 --store out/runs --json out/results.json",
    "runs --store out/runs",
    "requirements pickplace.bdd --store out/runs",
    "judge latest pickplace.bddx --store out/runs",
    "replay latest --store out/runs",
    "compare latest latest --store out/runs",
    "report latest -o out/report.html --store out/runs",
    "evidence pack latest -o out/evidence.zip --store out/runs",
    "evidence verify out/evidence.zip --user-code",
    "study run one.study --store out/studies",
    "study export one.study -o out/rows.csv --store out/studies",
    "study outcomes one.study --plot out/outcomes.svg --store out/studies",
    "study margins one.study --clause at-goal --by thing --store out/studies",
    "study replay one.study 1 --store out/studies",
    "study clean one.study --store out/studies",
    "study plan --width 0.05",
    "falsify ranged.study --budget 1 --method uniform",
    "mutate pickplace.bdd --first 1 --fault no-grip --json out/faults.json",
    "export latest --ros2 -o out/bag --store out/runs",
    "import event.ttl -o out/imported.bdd",
    "new out/bench",
    "cut tote.obj",
    "doctor",
    "dap",
)
STARTING = (
    "check .",
    *(command for command in COMMANDS if command.split()[0] in {"gherkin", "run", "judge"}),
)
"""Commands that start processes, one of each kind. ``PYTHONPATH`` goes before it is known which command is executed."""
A_STUDY = 'import "pickplace.bddx" Study one { first: 1 }'
AN_EVENT = "<https://example.org/t/end> a <https://secorolab.github.io/metamodels/time#Event> ."
FINDINGS = 1


RULE = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
<urn:rule> a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ; sh:severity sh:Warning ; sh:property [
    sh:path <urn:never> ; sh:minCount 1 ; sh:severity sh:Warning ; sh:message "a rule of the project" ] .
"""


async def _published(client: LanguageClient, uri: str, code: str) -> None:
    async with asyncio.timeout(PATIENCE):
        while code not in [str(entry.code) for entry in client.diagnostics.get(uri, [])]:
            await asyncio.sleep(0.02)


def _ignore(*_: object) -> None:
    return None


def environment(python_path: str | None) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "ROBBDD_"))}
    if python_path is None:
        return kept
    relative = dict.fromkeys(("PYTHONHOME", "PYTHONUSERBASE", "PYTHONPYCACHEPREFIX"), ".")
    return {**kept, **relative, "PYTHONPATH": python_path}


def test_the_trap_works(tmp_path: Path) -> None:
    hostile = HostileFolder(tmp_path)
    command = [sys.executable, "-c", "import calendar, rdflib, robbdd_tools.cli"]
    subprocess.run(command, cwd=hostile.models, env=environment(None), capture_output=True)
    assert {"calendar", "rdflib", "robbdd_tools"} <= set(hostile.imported())
    assert len(importable_names()) > 300


@pytest.mark.physics
@pytest.mark.skipif(os.name == "nt", reason="the interpreter reads PYTHONPATH before the commands of Windows can help")
@pytest.mark.parametrize(
    ("inside", "python_path", "commands"),
    [
        pytest.param(True, None, COMMANDS, id="inside"),
        pytest.param(True, ":", STARTING, id="inside-empty-entry"),
        pytest.param(False, ":models:.", STARTING, id="outside-relative-entries"),
        pytest.param(True, ":", COMMANDS, id="inside-empty-entry-all", marks=pytest.mark.nightly),
        pytest.param(False, ":models:.", COMMANDS, id="outside-relative-entries-all", marks=pytest.mark.nightly),
    ],
)
def test_no_command_imports_a_planted_module(
    inside: bool, python_path: str | None, commands: tuple[str, ...], tmp_path: Path
) -> None:
    hostile = HostileFolder(tmp_path)
    (hostile.models / "event.ttl").write_text(AN_EVENT, encoding="utf-8")
    (hostile.models / "one.study").write_text(A_STUDY, encoding="utf-8")
    write_ranged_study(hostile.models)
    write_tote(hostile.models / "tote.obj")
    start = hostile.models if inside else hostile.root
    assert {command.partition(" ")[0] for command in COMMANDS} == command_names()
    for command in commands:
        words = command.split()
        if not inside:
            names = {path.name for path in hostile.models.iterdir()} | {"."}
            words = [str(hostile.models / word) if word in names else word for word in words]
        done = subprocess.run(
            [SCRIPTS / "robbdd", *words],
            cwd=start,
            env=environment(python_path),
            capture_output=True,
            text=True,
            stdin=subprocess.DEVNULL,
        )
        assert hostile.imported() == [], command
        assert done.returncode in (0, FINDINGS), (command, done.stderr)
        assert "Traceback" not in done.stderr, (command, done.stderr)


@pytest.mark.parametrize("module", ["robbdd_tools", "robbdd_tools.lsp"])
def test_an_interpreter_that_reads_no_environment_imports_no_planted_module(module: str, tmp_path: Path) -> None:
    hostile = HostileFolder(tmp_path)
    command = [sys.executable, "-I", "-m", module, "--version"]
    done = subprocess.run(
        command, cwd=hostile.models, env={**environment(None), "PYTHONPATH": os.pathsep}, capture_output=True, text=True
    )
    assert (done.returncode, done.stdout.split()[-1:], done.stderr) == (0, [__version__], "")
    assert hostile.imported() == []


def test_a_command_that_python_has_started_in_the_working_directory_says_so(tmp_path: Path) -> None:
    command = [sys.executable, "-P", "-m", "robbdd_tools", "--version"]
    for python_path, warned in ((os.pathsep, EXPOSED), (f"{tmp_path}{os.pathsep}x", EXPOSED), (str(tmp_path), "")):
        done = subprocess.run(
            command, cwd=tmp_path, env={**environment(None), "PYTHONPATH": python_path}, capture_output=True, text=True
        )
        assert (done.returncode, done.stderr) == (0, warned)


@pytest.mark.physics
@pytest.mark.skipif(os.name == "nt", reason="the interpreter reads PYTHONPATH before the commands of Windows can help")
@pytest.mark.parametrize(
    ("trusted", "python_path"),
    [
        pytest.param(True, None, id="trusted-clean"),
        pytest.param(False, None, id="untrusted-clean"),
        pytest.param(True, ":", id="trusted-empty-entry"),
        pytest.param(False, ":", id="untrusted-empty-entry", marks=pytest.mark.nightly),
    ],
)
async def test_no_process_of_the_server_imports_a_planted_module(
    trusted: bool, python_path: str | None, tmp_path: Path
) -> None:
    hostile = HostileFolder(tmp_path)
    (hostile.models / "robbdd.toml").write_text('shapes = ["rule.ttl"]\n', encoding="utf-8")
    (hostile.models / "rule.ttl").write_text(RULE, encoding="utf-8")
    (hostile.models / "closed.bdd").write_text("Scenario (", encoding="utf-8")
    client = make_test_lsp_client()
    for method in ASKED:
        # In place of what pytest-lsp may do by itself; pygls leaves the type of its table open.
        client.protocol.fm.features[method] = _ignore  # pyright: ignore[reportUnknownMemberType]
    start = cast(Any, client).start_io
    await start(str(SCRIPTS / "robbdd-lsp"), "--stdio", cwd=hostile.models, env=environment(python_path))
    await client.initialize_session(
        types.InitializeParams(
            capabilities=client_capabilities("visual-studio-code"),
            workspace_folders=[types.WorkspaceFolder(uri=path_to_uri(hostile.root), name="hostile")],
            initialization_options={"trusted": trusted},
        )
    )
    path = hostile.models / "pickplace.bdd"
    uri = path_to_uri(path)
    item = types.TextDocumentItem(uri=uri, language_id="bdd", version=0, text=path.read_text(encoding="utf-8"))
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))

    async def execute(command: str, **options: object) -> Any:
        params = types.ExecuteCommandParams(command=command, arguments=[{"uri": uri, **options}])
        return await client.workspace_execute_command_async(params)

    # The process for open files has found this one, the process for all others the next one.
    await _published(client, uri, "shape-rule")
    await _published(client, path_to_uri(hostile.models / "closed.bdd"), "syntax")
    answer = await execute("robbdd.run", first=1)
    assert ("problem" in cast("dict[str, Any]", answer)) is not trusted, answer
    await execute("robbdd.gherkin")
    assert hostile.imported() == []
    await client.shutdown_session()
    assert hostile.imported() == []
