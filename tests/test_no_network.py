"""No command and no request reaches the network, whatever the files of a folder ask for."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.graph.query import BadQuery, run_query
from robbdd_tools.graph.serialize import parse

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
    "check .",
    "check graph.ttl foreign.jsonld",
    "graph pickplace.bdd",
    "graph graph.ttl",
    "graph foreign.jsonld",
    "gherkin pickplace.bdd -o out",
    "import foreign.jsonld -o out/foreign.bdd",
    "run remote.bddx --first 1 --no-store",
    "view pickplace.bdd -o out.png",
    "format --check .",
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
    return models


@pytest.mark.physics
def test_no_command_contacts_a_server(folder: Path, contacts: tuple[str, list[str]], tmp_path: Path) -> None:
    environment = {**os.environ, "ROBBDD_CONFIG": str(tmp_path / "none.toml"), "ROBBDD_CACHE": str(tmp_path / "cache")}
    for command in COMMANDS:
        process = [sys.executable, "-P", "-m", "robbdd_tools.cli", *command.split()]
        done = subprocess.run(process, cwd=folder, env=environment, capture_output=True, encoding="utf-8")
        assert contacts[1] == [], command
        assert "Traceback" not in done.stderr, (command, done.stderr)
    process = [sys.executable, "-P", "-m", "robbdd_tools.cli", "check", "foreign.jsonld", "--allow-host", "127.0.0.1"]
    subprocess.run(process, cwd=folder, env=environment, capture_output=True)
    assert contacts[1] == ["/c.jsonld"], "the server counts"


QUERIES = ("SELECT * FROM <{}/g> {{ ?s ?p ?o }}", "SELECT * {{ SERV\\u0049CE <{}/s> {{ ?s ?p ?o }} }}")


@pytest.mark.parametrize("form", QUERIES)
def test_no_query_contacts_a_server(form: str, contacts: tuple[str, list[str]]) -> None:
    with pytest.raises(BadQuery, match="SERVICE and FROM are not followed"):
        run_query(parse("<urn:a> <urn:b> <urn:c> .", "ttl"), form.format(contacts[0]))
    assert contacts[1] == []
