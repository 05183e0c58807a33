"""Models that are graphs: read as they are, findings at their lines, contexts only from where the user allows."""

from __future__ import annotations

import json
import re
import socket
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from itertools import count
from pathlib import Path

import pytest

from graph.statements import built
from kit import MODEL, corpus
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document
from robbdd_tools.graph.rdf import contexts
from robbdd_tools.graph.rdf.contexts import CONTEXT_IRI, ContextLoader
from robbdd_tools.graph.rdf.serialize import UnreadableGraph, parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.graph.write.foreign import read_graph_file
from robbdd_tools.names.project import Project

FOREIGN = """@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
@prefix rtime: <https://secorolab.github.io/metamodels/time#> .
@prefix owl-time: <http://www.w3.org/2006/time#> .
@prefix task: <https://secorolab.github.io/metamodels/task#> .
@prefix bhv: <https://secorolab.github.io/metamodels/behaviour#> .
@prefix env: <https://secorolab.github.io/metamodels/environment#> .
@prefix agn: <https://secorolab.github.io/metamodels/agent#> .
@prefix ex: <https://example.org/cell#> .

ex:begin a owl-time:Instant, ex:Tick .  ex:done a owl-time:Instant .
ex:job a task:Task, ex:Job .
ex:cup a env:Object, ex:Cup .  ex:desk a env:Workspace .  ex:arm a agn:Agent, ex:Robot .
ex:thing a bdd:ScenarioVariable .  ex:place a bdd:ScenarioVariable .  ex:who a bdd:ScenarioVariable .

ex:moving a bdd:ScenarioTemplate, rtime:TimeConstraint, rtime:DuringEventsConstraint ;
    rtime:after-event ex:begin ; rtime:before-event ex:done ;
    bdd:of-scenario ex:moving-scenario ; bdd:has-scene ex:stage ;
    bdd:has-clause ( ex:act ex:there ) .
ex:stage a bdd:Scene .
ex:moving-scenario a bdd:Scenario ; bdd:given ex:g ; bdd:when ex:w ; bdd:then ex:t ;
    task:of-task ex:job ; bhv:of-behaviour ex:carry .
ex:g a bdd:Given .  ex:w a bdd:When .  ex:t a bdd:Then .
ex:carry a bhv:Behaviour, bhv:Pick, bhv:Place .
ex:act a bdd:WhenBehaviour, rtime:TimeConstraint, rtime:DuringEventsConstraint ;
    bdd:clause-of ex:w ; bhv:of-behaviour ex:carry ; bhv:target-agent ex:who ; bhv:target-object ex:thing ;
    bhv:target-workspace ex:place ; rtime:after-event ex:begin ; rtime:before-event ex:done .
ex:there a bdd:FluentClause, bdd:LocatedAtPredicate, rtime:TimeConstraint, rtime:AfterEventConstraint ;
    bdd:clause-of ex:t ; bdd:ref-object ex:thing ; bdd:ref-workspace ex:place ; rtime:after-event ex:done .

ex:story a bdd:UserStory ; bdd:has-criteria ex:variant .
ex:variant a bdd:ScenarioVariant ; bdd:of-template ex:moving ; bdd:has-variation ex:values ;
    bdd:has-scene [ a bdd:SceneHasObjects ; bdd:of-scene ex:stage ; env:has-object ex:cup ] ,
        [ a bdd:SceneHasWorkspaces ; bdd:of-scene ex:stage ; env:has-workspace ex:desk ] ,
        [ a bdd:SceneHasAgents ; bdd:of-scene ex:stage ; agn:has-agent ex:arm ] .
ex:values a bdd:TaskVariation, bdd:TableVariation ; task:of-task ex:job ;
    bdd:variable-list ( ex:thing ex:place ex:who ) ; bdd:rows ( ( ex:cup ex:desk ex:arm ) ) .
"""
"""A model that was not written in RobBDD: other names, blank nodes, several types, events as OWL-Time instants."""


def findings(text: str, name: str = "model.ttl") -> list[Diagnostic]:
    return validate(read_graph_file(Document(f"file:///models/{name}", 1, text)))


def lines(text: str, name: str = "model.ttl") -> list[tuple[int, str, str]]:
    document = Document("", 0, text)
    return [(document.position(d.span.start).line + 1, d.code, d.message) for d in findings(text, name)]


def line_of(text: str, words: str) -> int:
    return text[: text.index(words)].count("\n") + 1


def test_a_model_that_was_never_written_in_robbdd_is_accepted_and_understood() -> None:
    assert findings(FOREIGN) == []
    (story,) = read_model(parse(FOREIGN, "ttl")).stories
    (variant,) = story.variants
    assert len(variant.template.clauses) == 2
    assert [len(part) for part in (variant.scene.objects, variant.scene.workspaces, variant.scene.agents)] == [1, 1, 1]


def test_the_same_model_in_json_ld_is_accepted() -> None:
    assert findings(serialize(parse(FOREIGN, "ttl"), "json-ld"), "model.json") == []


def test_a_finding_stands_at_the_node_and_names_it() -> None:
    text = FOREIGN.replace("    task:of-task ex:job ; bhv", "    bhv")
    assert lines(text) == [
        (
            line_of(text, "ex:moving-scenario a"),
            "shacl-scenario-task",
            "'ex:moving-scenario': the template does not say which task its scenario belongs to: "
            "write 'task: <task>' after the duration",
        )
    ]


def test_a_finding_about_a_blank_node_stands_at_the_node_that_has_it() -> None:
    text = FOREIGN.replace("bdd:of-scene ex:stage ; agn", "agn")
    ((line, code, message),) = lines(text)
    assert (line, code) == (line_of(text, "ex:variant a"), "shacl-membership-scene")
    assert message.startswith("'a node of ex:variant': ")


def test_a_finding_in_json_stands_at_the_description_of_the_node() -> None:
    graph = parse(FOREIGN.replace("    task:of-task ex:job ; bhv", "    bhv"), "ttl")
    text = serialize(graph, "json-ld")
    assert [(line, code) for line, code, _ in lines(text, "m.jsonld")] == [
        (line_of(text, '"@id": "ex:moving-scenario"'), "shacl-scenario-task")
    ]


def test_an_unread_variant_is_an_error_where_no_shape_tells_the_cause() -> None:
    text = FOREIGN.replace("bdd:variable-list ( ex:thing ex:place ex:who )", "bdd:variable-list ( ex:thing ex:place )")
    assert all(d.severity is Severity.ERROR for d in findings(text))
    assert findings(text)


@pytest.mark.parametrize(
    ("name", "text", "line", "words"),
    [
        (
            "m.ttl",
            "@prefix ex: <https://example.org/> .\nex:a ex:b ex:c\nex:d ex:e ex:f .",
            2,
            "not a graph in the format ttl",
        ),
        ("m.json", '{\n  "@id": "x:y",\n}', 3, "not a graph in the format json-ld"),
        ("m.json", '{"@context": "https://example.org/c.json"}', 1, "'--allow-host example.org'"),
        ("m.ttl", "<https://example.org/a> a <https://example.org/b> .", 1, "is it the right file?"),
    ],
)
def test_a_file_that_is_no_model_is_refused_at_its_place(name: str, text: str, line: int, words: str) -> None:
    ((found, _, message),) = lines(text, name)
    assert found in (line - 1, line, line + 1)
    assert words in message


def test_our_graphs_mean_the_same_when_they_are_read(tmp_path: Path) -> None:
    graph = built(MODEL).graph
    path = tmp_path / "model.ttl"
    path.write_text(serialize(graph, "ttl"), encoding="utf-8")
    project = Project()
    project.load(path.as_uri())
    again = build_graph(project.snapshot(), path.as_uri())
    assert validate(again) == []
    assert read_model(again.graph) == read_model(graph)


def test_the_reference_graphs_are_accepted() -> None:
    for path in corpus(".bdd"):
        reference = path.parent.parent / "graphs" / f"{path.name}.ttl"
        if reference.exists():
            assert findings(reference.read_text(encoding="utf-8")) == [], path.name


def test_our_context_is_known_by_its_name() -> None:
    document = {"@context": [CONTEXT_IRI, {"ex": "https://example.org/"}], "@id": "ex:begin", "@type": "Event"}
    graph = parse(json.dumps(document), "json-ld")
    assert [str(kind) for kind in graph.objects()] == ["https://secorolab.github.io/metamodels/time#Event"]
    assert dict(graph.namespaces())["ex"].toPython() == "https://example.org/"


def test_a_context_beside_the_model_is_read(tmp_path: Path) -> None:
    (tmp_path / "own.jsonld").write_text('{"@context": {"ex": "https://example.org/"}}', encoding="utf-8")
    document = json.dumps({"@context": "own.jsonld", "@id": "ex:a", "@type": "ex:b"})
    assert len(parse(document, "json-ld", (tmp_path / "m.json").as_uri())) == 1
    with pytest.raises(UnreadableGraph, match=r"there is no file 'other\.jsonld'"):
        parse(document.replace("own", "other"), "json-ld", (tmp_path / "m.json").as_uri())


@contextmanager
def serving(reply: Callable[[BaseHTTPRequestHandler], object]) -> Generator[tuple[str, list[str]]]:
    """Run a server on this machine; yields its address and the list of the paths that it is asked for."""
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            reply(self)

        def log_message(self, format: str, *args: object) -> None:
            """Keep quiet."""

    server = HTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", asked
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, list[str]]]:
    """A local server with its recorded requests, and a separate cache."""
    monkeypatch.setenv("ROBBDD_CACHE", str(tmp_path / "cache"))

    def reply(answer: BaseHTTPRequestHandler) -> None:
        answer.send_response(200)
        answer.end_headers()
        answer.wfile.write(b'{"@context": {"ex": "https://example.org/"}}')

    with serving(reply) as found:
        yield found


def test_the_network_is_asked_once_and_only_by_permission(served: tuple[str, list[str]]) -> None:
    address, asked = served
    text = json.dumps({"@context": f"{address}/c.json", "@id": "ex:a", "@type": "ex:b"})
    with pytest.raises(UnreadableGraph, match=r"allow it once with '--allow-host 127\.0\.0\.1'"):
        parse(text, "json-ld", loader=ContextLoader(frozenset({"localhost"})))
    assert asked == []
    assert len(parse(text, "json-ld", loader=ContextLoader(frozenset({"127.0.0.1"})))) == 1
    assert len(parse(text, "json-ld")) == 1
    assert asked == ["/c.json"]


@pytest.mark.parametrize(
    ("target", "words"),
    [("file", "not allowed"), ("ftp", "not a web address"), ("host", "not fetched: allow it .*--allow-host localhost")],
)
def test_a_redirection_leads_to_no_file_and_to_no_other_host(
    target: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROBBDD_CACHE", str(tmp_path / "cache"))
    context = '{"@context": {"ex": "https://example.org/"}}'
    (tmp_path / "secret.json").write_text(context, encoding="utf-8")
    with serving(lambda answer: answer.wfile.write(context.encode())) as (there, reached):
        elsewhere = {
            "file": (tmp_path / "secret.json").as_uri(),
            "ftp": there.replace("http:", "ftp:"),
            "host": there.replace("127.0.0.1", "localhost"),
        }

        def redirect(answer: BaseHTTPRequestHandler) -> None:
            answer.send_response(302)
            answer.send_header("Location", elsewhere[target])
            answer.end_headers()

        with serving(redirect) as (here, asked):
            text = json.dumps({"@context": f"{here}/c.json", "@id": "ex:a", "@type": "ex:b"})
            for _ in range(2):
                with pytest.raises(UnreadableGraph, match=rf"{re.escape(elsewhere[target])}/?' is {words}"):
                    parse(text, "json-ld", loader=ContextLoader(frozenset({"127.0.0.1"})))
            assert asked == ["/c.json", "/c.json"], "nothing of it is kept"
        assert reached == []


def test_a_server_that_never_ends_its_answer_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBBDD_CACHE", str(tmp_path / "cache"))
    # Each look at the clock finds it nine seconds on.
    monkeypatch.setattr(contexts, "monotonic", count(0, 9).__next__)
    left = threading.Event()

    def trickle(answer: BaseHTTPRequestHandler) -> None:
        answer.send_response(200)
        answer.end_headers()
        try:
            while True:
                answer.wfile.write(b" ")
        except OSError:
            left.set()

    with serving(trickle) as (address, _):
        text = json.dumps({"@context": f"{address}/c.json", "@id": "ex:a", "@type": "ex:b"})
        with pytest.raises(UnreadableGraph, match="cannot be fetched: the server takes longer than 20 s"):
            parse(text, "json-ld", loader=ContextLoader(frozenset({"127.0.0.1"})))
        assert left.wait(60)


def test_a_server_that_does_not_answer_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBBDD_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(contexts, "TIMEOUT", 0.05)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"http://127.0.0.1:{silent.getsockname()[1]}"
        text = json.dumps({"@context": f"{address}/c.json", "@id": "ex:a", "@type": "ex:b"})
        with pytest.raises(UnreadableGraph, match="cannot be fetched: timed out"):
            parse(text, "json-ld", loader=ContextLoader(frozenset({"127.0.0.1"})))


def test_a_damaged_copy_is_not_used(served: tuple[str, list[str]], tmp_path: Path) -> None:
    address, asked = served
    text = json.dumps({"@context": f"{address}/c.json", "@id": "ex:a", "@type": "ex:b"})
    parse(text, "json-ld", loader=ContextLoader(frozenset({"127.0.0.1"})))
    (copy,) = (tmp_path / "cache" / "contexts").iterdir()
    copy.write_text(copy.read_text(encoding="utf-8").replace("example.org", "example.net"), encoding="utf-8")
    with pytest.raises(UnreadableGraph, match="is not fetched"):
        parse(text, "json-ld")
    assert asked == ["/c.json"]
