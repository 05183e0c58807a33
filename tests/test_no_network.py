"""No command and no request reaches the network, whatever the files of a folder contain."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import subprocess
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.protocol import default_converter
from pytest_lsp import LanguageClient, client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD, ROBBDD_LSP
from kit import EXAMPLES, command_names
from lsp_kit import ASKED, PATIENCE
from planting_kit import write_ranged_study
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.ask.query import BadQuery, run_query
from robbdd_tools.graph.rdf.serialize import parse

pytestmark = pytest.mark.usefixtures("forks")

SHAPES = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
@base <ADDRESS/base> .
<ADDRESS/o> a owl:Ontology ; owl:imports <ADDRESS/imported.ttl> .
<urn:s> a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ;
    sh:sparql [ sh:select "SELECT $this FROM <ADDRESS/from.ttl> WHERE { $this a ?c }" ] .
"""
SERVICE = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
<urn:t> a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ;
    sh:sparql [ sh:select "SELECT $this WHERE { SERV\\\\u0049CE <ADDRESS/sparql> { $this a ?c } }" ] .
"""
SCENE = """<?xml version="1.0"?>
<!DOCTYPE mujoco SYSTEM "ADDRESS/scene.dtd" [ <!ENTITY remote SYSTEM "ADDRESS/entity.xml"> ]>
<mujoco><worldbody><body><geom type="mesh" mesh="m"/></body></worldbody>
<asset><mesh name="m" file="ADDRESS/mesh.obj"/></asset>&remote;</mujoco>
"""
COMMANDS = (
    "completion bash",
    "check .",
    "check graph.ttl foreign.jsonld",
    "graph pickplace.bdd",
    "requirements pickplace.bdd",
    "graph graph.ttl",
    "graph foreign.jsonld",
    "gherkin pickplace.bdd -o out",
    "import foreign.jsonld -o out/foreign.bdd",
    "run remote.bddx --first 1 --no-store",
    "run pickplace.bddx --first 1 --no-store",
    "view pickplace.bddx -o out.png",
    "run pickplace.bdd --first 1 --store runs",
    "judge latest pickplace.bdd --store runs",
    "replay latest --store runs --force",
    "compare latest latest --store runs",
    "report latest -o report.html --store runs",
    "evidence pack latest -o evidence.zip --store runs",
    "evidence verify evidence.zip",
    "study run one.study --store studies",
    "study status one.study --store studies",
    "study outcomes one.study --store studies",
    "study margins one.study --clause at-goal --by thing --store studies",
    "study replay one.study 1 --store studies",
    "study clean one.study --store studies",
    "study plan --width 0.05",
    "falsify ranged.study --budget 1 --method uniform",
    "mutate pickplace.bdd --first 1 --fault no-grip",
    "query pickplace.bdd --name variants",
    "steps pickplace.bdd",
    "view pickplace.bdd -o out.png",
    "format --check .",
    "runs --store runs",
    "export latest --ros2 -o bag --store runs",
    "new out/bench",
    "cut five.xml",
    "doctor",
    "dap",
)


@pytest.fixture
def contacts() -> Iterator[tuple[str, list[str]]]:
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_response(404)
            self.end_headers()

        do_POST = do_HEAD = do_GET

        def log_message(self, format: str, *args: object) -> None:
            """Keep quiet."""

    server = HTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}", asked
    server.shutdown()
    thread.join()
    server.server_close()


@pytest.fixture
def folder(tmp_path: Path, contacts: tuple[str, list[str]]) -> Path:
    """An example among files that name the server in every way that a format has."""
    address, _ = contacts
    models = tmp_path / "models"
    shutil.copytree(EXAMPLES / "pickplace", models)
    study = 'import "pickplace.bdd" Study one { first: 1 }'
    (models / "one.study").write_text(study, encoding="utf-8")
    write_ranged_study(models)
    texts = {
        "robbdd.toml": 'shapes = ["shapes.ttl", "service.ttl"]\ncontext-hosts = ["127.0.0.1"]\n',
        "shapes.ttl": SHAPES,
        "service.ttl": SERVICE,
        "five.xml": SCENE,
        "graph.ttl": "@base <ADDRESS/x> .\n<> <http://www.w3.org/2002/07/owl#imports> <o.ttl> .\n",
        "foreign.jsonld": json.dumps({"@context": "ADDRESS/c.jsonld", "@id": "urn:a", "http://e.org/p": 1}),
        "remote.bdd": 'import "ADDRESS/remote.bdd"\nimport "ADDRESS/remote.scene"\n',
        "remote.bddx": 'import "ADDRESS/remote.bdd"\nimport "pickplace.bddx"\n',
    }
    for name, text in texts.items():
        (models / name).write_text(text.replace("ADDRESS", address), encoding="utf-8")
    scenes = models / "bench.scenex"
    text = scenes.read_text(encoding="utf-8")
    assert '{ catalog "cube" }' in text
    scenes.write_text(text.replace('{ catalog "cube" }', "{ sys path = 'five.xml' }"), encoding="utf-8")
    return models


def environment(folder: Path) -> dict[str, str]:
    return {**os.environ, "ROBBDD_CONFIG": str(folder / "none.toml"), "ROBBDD_CACHE": str(folder / "cache")}


@pytest.mark.physics
def test_no_command_contacts_a_server(folder: Path, contacts: tuple[str, list[str]], tmp_path: Path) -> None:
    assert {command.partition(" ")[0] for command in COMMANDS} == command_names()
    for command in COMMANDS:
        process = [*ROBBDD, *command.split()]
        variables, nothing = environment(tmp_path), subprocess.DEVNULL
        done = subprocess.run(process, cwd=folder, env=variables, capture_output=True, encoding="utf-8", stdin=nothing)
        assert contacts[1] == [], command
        assert "Traceback" not in done.stderr, (command, done.stderr)
    process = [*ROBBDD, "check", "foreign.jsonld", "--allow-host", "127.0.0.1"]
    subprocess.run(process, cwd=folder, env=environment(tmp_path), capture_output=True)
    assert contacts[1] == ["/c.jsonld"], "the server counts"


@pytest.mark.physics
@pytest.mark.parametrize("trusted", [True, False], ids=["trusted", "untrusted"])
async def test_no_request_contacts_a_server(
    trusted: bool, folder: Path, contacts: tuple[str, list[str]], tmp_path: Path
) -> None:
    client = make_test_lsp_client()
    for method in ASKED:
        # In place of what pytest-lsp may do by itself; pygls leaves the type of its table open.
        client.protocol.fm.features[method] = _ignore  # pyright: ignore[reportUnknownMemberType]
    await cast(Any, client).start_io(*ROBBDD_LSP, "--stdio", env=environment(tmp_path))
    capabilities = client_capabilities("visual-studio-code")
    assert capabilities.text_document is not None
    assert capabilities.workspace is not None
    capabilities.text_document.diagnostic = types.DiagnosticClientCapabilities()
    capabilities.workspace.diagnostics = types.DiagnosticWorkspaceClientCapabilities(refresh_support=True)
    await client.initialize_session(
        types.InitializeParams(
            capabilities=capabilities,
            workspace_folders=[types.WorkspaceFolder(uri=path_to_uri(folder), name="hostile")],
            initialization_options={"trusted": trusted, "pictures": True, "replay": True},
        )
    )
    for name in ("pickplace.bdd", "remote.bdd", "bench.scene", "bench.scenex", "pickplace.bddx", "remote.bddx"):
        await _ask_all(client, folder / name, contacts[1])
    # The project's shapes, the most likely to use the network, have been checked by now.
    model = types.TextDocumentIdentifier(path_to_uri(folder / "pickplace.bdd"))
    async with asyncio.timeout(PATIENCE):
        while "shapes-unchecked" not in await _codes(client, model):
            await asyncio.sleep(0.02)
    for method in ("robbdd/testResults", "robbdd/templates", "robbdd/tests", "robbdd/versions"):
        await client.protocol.send_request_async(method, {})
    (folder / "x.study").write_text('import "remote.bdd"\n\nStudy x { }\n', encoding="utf-8")
    with pytest.raises(JsonRpcException, match="the study has no results"):
        await client.protocol.send_request_async("robbdd/study", {"uri": path_to_uri(folder / "x.study")})
    symbols = types.WorkspaceSymbolParams(query="")
    await client.workspace_symbol_async(symbols)
    assert contacts[1] == []
    await client.shutdown_session()
    assert contacts[1] == []


async def _codes(client: LanguageClient, document: types.TextDocumentIdentifier) -> list[str]:
    found = await client.text_document_diagnostic_async(types.DocumentDiagnosticParams(document))
    assert isinstance(found, types.RelatedFullDocumentDiagnosticReport)
    return [str(entry.code) for entry in found.items]


def _ignore(*_: object) -> None:
    return None


async def _ask_all(client: LanguageClient, path: Path, asked: list[str]) -> None:
    """Open a document and send every request about it, those about a position for each line with a name."""
    uri, text = path_to_uri(path), path.read_text(encoding="utf-8")
    item = types.TextDocumentItem(uri=uri, language_id=path.suffix[1:], version=0, text=text)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
    document = {"textDocument": {"uri": uri}}
    lines = text.splitlines()
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": len(lines), "character": 0}}
    converter = cast(Any, default_converter())

    async def send(method: str, params: dict[str, Any]) -> None:
        known: Any = cast("dict[str, Any]", types.METHOD_TO_TYPES).get(method)
        structured: Any = params if known is None else converter.structure(params, known[2])
        await client.protocol.send_request_async(method, structured)

    async def ask(method: str, **more: object) -> None:
        await send(f"textDocument/{method}", {**document, **more})
        assert asked == [], (method, more)

    for method in ("diagnostic", "documentSymbol", "foldingRange", "documentLink", "codeLens", "semanticTokens/full"):
        await ask(method)
    await ask("inlayHint", range=whole)
    await ask("codeAction", range=whole, context={"diagnostics": []})
    await ask("formatting", options={"tabSize": 4, "insertSpaces": True})
    for number, line in enumerate(lines):
        if "import" in line or "<" in line:
            position = {"line": number, "character": line.find("<") + 1 or line.find('"') + 1}
            for method in ("hover", "definition", "completion"):
                await ask(method, position=position)
            await ask("references", position=position, context={"includeDeclaration": True})
    for method in ("graph", "preview", "tests", "runs", "importResults"):
        await send(f"robbdd/{method}", {"uri": uri})
        assert asked == [], method
    for command in ("run", "record", "gherkin", "steps"):
        await send(
            "workspace/executeCommand", {"command": f"robbdd.{command}", "arguments": [{"uri": uri, "first": 1}]}
        )
        assert asked == [], command


NOT_FOLLOWED = "SERVICE and FROM are not followed"
QUERIES = {
    "SELECT * FROM <{}/g> {{ ?s ?p ?o }}": NOT_FOLLOWED,
    "SELECT * {{ SERV\\u0049CE <{}/s> {{ ?s ?p ?o }} }}": NOT_FOLLOWED,
    "LOAD <{}/g>": ".",
    "LOAD <{}/g> INTO GRAPH <urn:g>; SELECT * {{ ?s ?p ?o }}": ".",
}


@pytest.mark.parametrize(("form", "words"), QUERIES.items())
def test_no_query_contacts_a_server(form: str, words: str, contacts: tuple[str, list[str]]) -> None:
    with pytest.raises(BadQuery, match=words):
        run_query(parse("<urn:a> <urn:b> <urn:c> .", "ttl"), form.format(contacts[0]))
    assert contacts[1] == []
