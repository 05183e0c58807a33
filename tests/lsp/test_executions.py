"""Executions of a ``.bddx`` in the test tree: listed, run separately, each with its own results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from pytest_lsp import client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD_LSP
from kit import schema_errors
from lsp_kit import Editor, begin_session, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main

VARIANT = "https://example.org/robbdd/criteria/part-to-bin"
ONE, TWO = (f"https://example.org/robbdd/execution/{name}" for name in ("in-simulation", "far-too-strict"))
STRICT = """
obs policy (ns=exec) on-the-spot for <pick-place.at-goal> horizon: 0.5 seconds {
    observations: { <thing-pose>, <goal-pose> }
    evaluator: linear distance { less-than: 0.0001 m max time offset: 0.02 s }
}

Scenario Exec (ns=exec) far-too-strict {
    variant: <tidy-bench.part-to-bin>
    scene inst: <bench_sim>
    bhv: <built-in>
    policies: { <on-the-spot> }
    repeat: 2
}
"""


@pytest.fixture
def model(editor: Editor) -> Path:
    """The example's executions, with one more that no arm can pass, as it says itself."""
    path = editor.path.with_suffix(".bddx")
    path.write_text(path.read_text(encoding="utf-8") + STRICT, encoding="utf-8")
    return path


async def ask(editor: Editor, request: str, schema: str, **params: object) -> Any:
    answer = plain(await editor.client.protocol.send_request_async(f"robbdd/{request}", params))
    assert schema_errors(f"{schema}.schema.json", answer) == []
    return answer


async def executions(editor: Editor, model: Path) -> list[Any]:
    (file,) = (await ask(editor, "tests", "tests", uri=path_to_uri(model)))["tests"]
    assert (file["kind"], file["name"]) == ("file", "pickplace.bddx")
    return list(file["tests"])


async def run(editor: Editor, model: Path, command: str = "run", **options: object) -> Any:
    target = {"uri": path_to_uri(model), **options}
    params = types.ExecuteCommandParams(command=f"robbdd.{command}", arguments=[target])
    return plain(await editor.client.workspace_execute_command_async(params))


async def test_an_execution_is_told_with_what_it_says(editor: Editor, model: Path) -> None:
    assert path_to_uri(model) in (await ask(editor, "tests", "tests"))["files"]
    one, two = await executions(editor, model)
    assert (one["id"], one["kind"], one["name"], one["variant"]) == (ONE, "execution", "in-simulation", VARIANT)
    said = ("tidy-bench.part-to-bin", "4 scenarios", "by built-in", "in bench_sim")
    assert one["detail"].split(" · ") == [*said, "policies near-goal, starts-outside", "seed 1"]
    assert "2 times each" in two["detail"]
    line = int(one["place"]["range"]["start"]["line"])
    assert model.read_text(encoding="utf-8").split("\n")[line].startswith("Scenario Exec (ns=exec) in-simulation")
    listed = await ask(editor, "tests", "tests", uri=path_to_uri(model), variant=VARIANT, first=1, most=1)
    assert listed["tests"][0]["tests"][0]["name"] == "at-source"


@pytest.mark.parametrize(
    ("old", "new", "changed"),
    [
        ("seed: 1", "seed: 2", {ONE}),
        ("less-than: 0.2 m", "less-than: 0.1 m", {ONE}),
        ("0.0001 m", "0.0002 m", {TWO}),
        ("30 Hz noise: 2 mm", "30 Hz noise: 3 mm", {ONE}),
        ("bhv impl (ns=exec) built-in {", "// The same.\nbhv impl  (ns=exec) built-in {", set[str]()),
    ],
)
async def test_an_execution_is_another_when_what_it_names_changes(
    editor: Editor, model: Path, old: str, new: str, changed: set[str]
) -> None:
    before = {one["id"]: one["digest"] for one in await executions(editor, model)}
    text = model.read_text(encoding="utf-8").replace(old, new)
    item = types.TextDocumentItem(uri=path_to_uri(model), language_id="bddx", version=0, text=text)
    editor.client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
    after = {one["id"]: one["digest"] for one in await executions(editor, model)}
    assert {iri for iri, digest in after.items() if digest != before[iri]} == changed


@pytest.mark.physics
async def test_each_execution_has_results_of_its_own(editor: Editor, model: Path, run_messages: list[Any]) -> None:
    chosen = [
        {"variant": VARIANT, "execution": ONE, "variations": [1, 2]},
        {"variant": VARIANT, "execution": TWO, "variations": [1]},
    ]
    answer = await run(editor, model, only=chosen)
    assert {name: answer[name] for name in ("total", "holds", "violated")} == {"total": 4, "holds": 2, "violated": 2}
    started = [entry.message for entry in run_messages if entry.message.type == "ScenarioStarted"]
    assert sorted((one.execution, one.variation, one.repetition) for one in started) == [
        (TWO, 1, 1),
        (TWO, 1, 2),
        (ONE, 1, 1),
        (ONE, 2, 1),
    ]
    assert all(schema_errors("runmessage.schema.json", plain(entry)) == [] for entry in run_messages)

    async def kept() -> list[tuple[str, int, list[str]]]:
        found = (await ask(editor, "testResults", "testresults"))["scenarios"]
        told = [(one["execution"], one["variation"], [clause["verdict"] for clause in one["clauses"]]) for one in found]
        return sorted((by, number, sorted({*verdicts} - {"holds"})) for by, number, verdicts in told)

    every = sorted(((TWO, 1, ["violated"]), (TWO, 1, ["violated"]), (ONE, 1, list[str]()), (ONE, 2, list[str]())))
    assert await kept() == every
    for execution in (ONE, TWO):
        trace = await ask(editor, "trace", "trace", uri=path_to_uri(model), variant=VARIANT, execution=execution)
        assert trace["scenario"]["execution"] == execution
    # What one execution finds again leaves the other's results as they are; only what failed is run again.
    assert (await run(editor, model, only=chosen[:1]))["total"] == 2
    assert await kept() == every
    assert (await run(editor, model, "rerunFailed"))["total"] == 2
    assert await kept() == every


async def test_an_execution_that_is_gone_is_not_run(editor: Editor, model: Path) -> None:
    answer = await run(editor, model, only=[{"variant": VARIANT, "execution": f"{ONE}-2"}])
    assert "the model no longer has these scenarios" in answer["problem"]


@pytest.mark.parametrize("option", ["--json", "--junit"])
@pytest.mark.physics
async def test_results_of_ci_are_those_of_the_execution(editor: Editor, model: Path, option: str) -> None:
    results = model.with_name("results.ci")
    assert main(["run", str(model), "--scenario", "far-too-strict", "--first", "1", "--no-store", option, str(results)])
    found = (await ask(editor, "importResults", "testresults", uri=path_to_uri(results)))["scenarios"]
    assert [(one["uri"], one["variant"], one["execution"]) for one in found] == [(path_to_uri(model), VARIANT, TWO)] * 2


def show(editor: Editor, model: Path) -> None:
    text = model.read_text(encoding="utf-8")
    item = types.TextDocumentItem(uri=path_to_uri(model), language_id="robbdd", version=1, text=text)
    editor.client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))


async def lenses(editor: Editor, model: Path) -> list[tuple[str, Any]]:
    document = types.TextDocumentIdentifier(uri=path_to_uri(model))
    found = await editor.client.text_document_code_lens_async(types.CodeLensParams(text_document=document))
    commands = [lens.command for lens in found or () if lens.command is not None]
    return [(command.title, plain((command.arguments or [None])[0])) for command in commands]


async def test_each_execution_is_run_by_a_lens_of_its_own(editor: Editor, model: Path) -> None:
    show(editor, model)
    first, second = [{"variant": VARIANT, "execution": iri} for iri in (ONE, TWO)]
    uri = path_to_uri(model)
    assert await lenses(editor, model) == [
        ("Run", {"uri": uri, "only": [first]}),
        ("Record", {"uri": uri, "only": [first]}),
        ("4 scenarios", None),
        ("Run", {"uri": uri, "only": [second]}),
        ("Record", {"uri": uri, "only": [second]}),
        ("4 scenarios", None),
    ]
    document = types.TextDocumentIdentifier(uri=uri)
    line = model.read_text(encoding="utf-8").split("\n").index("    repeat: 2")
    place = types.Range(start=types.Position(line=line, character=0), end=types.Position(line=line, character=0))
    context = types.CodeActionContext(diagnostics=[], only=[types.CodeActionKind.Source])
    params = types.CodeActionParams(text_document=document, range=place, context=context)
    actions = await editor.client.text_document_code_action_async(params)
    assert [action.title for action in actions or ()] == ["Run execution far-too-strict"]


async def test_a_client_that_debugs_gets_a_lens_for_each_scenario_and_execution(tmp_path: Path) -> None:
    client: Any = make_test_lsp_client()
    await client.start_io(*ROBBDD_LSP, "--stdio")
    await begin_session(client, tmp_path, client_capabilities("visual-studio-code"), [], {"debugging": True})
    editor = Editor(client, tmp_path)
    found: list[Any] = []
    for path in (editor.path, editor.path.with_suffix(".bddx")):
        show(editor, path)
        document = types.TextDocumentIdentifier(uri=path_to_uri(path))
        lenses = await client.text_document_code_lens_async(types.CodeLensParams(text_document=document))
        commands = [lens.command for lens in lenses or () if lens.command is not None]
        found += [plain(one.arguments)[0] for one in commands if one.command == "robbdd.debugScenario"]
    await client.shutdown_session()
    assert [schema_errors("debugtarget.schema.json", one) for one in found] == [[] for _ in found]
    assert {Path(one.pop("uri")).suffix for one in found} == {".bdd", ".bddx"}
    assert {one["scenario"] for one in found} >= {VARIANT, ONE}
    assert [one for one in found if one["variant"] == VARIANT] == [
        {"scenario": VARIANT, "variant": VARIANT, "count": 4},
        {"scenario": ONE, "variant": VARIANT, "count": 4},
    ]


@pytest.mark.physics
async def test_a_lens_tells_how_often_an_execution_passed(editor: Editor, model: Path) -> None:
    await run(editor, model, only=[{"variant": VARIANT, "execution": TWO, "variations": [1]}])
    show(editor, model)
    found = dict(await lenses(editor, model))
    assert {"Rerun 2 failed", "✗ 2 of 8 executed, 0 passed"} < set(found)
    text = model.read_text(encoding="utf-8").replace("repeat: 2", "repeat: 1")
    document = types.VersionedTextDocumentIdentifier(uri=path_to_uri(model), version=2)
    change = types.TextDocumentContentChangeWholeDocument(text=text)
    editor.client.text_document_did_change(
        types.DidChangeTextDocumentParams(text_document=document, content_changes=[change])
    )
    assert "✗ 2 of 8 executed, 0 passed (stale)" in dict(await lenses(editor, model))
