"""Guarantees for every request: errors are contained, cancelled work ends, the event loop stays free."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest
import pytest_lsp
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from fork_kit import run_file
from lsp_kit import CLIENTS, PATIENCE, Editor, begin_session
from robbdd_tools.lsp.assistance import STILL_READING

PLANTED = Path(__file__).with_name("planted.py")
INTERNAL_ERROR, REQUEST_CANCELLED, CONTENT_MODIFIED = -32603, -32800, -32801
TOKENS = types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL


# pytest-lsp leaves the types of its decorator open.
@pytest_lsp.fixture(  # pyright: ignore[reportUnknownMemberType]
    config=ClientServerConfig(server_command=run_file(PLANTED)),
)
async def client(
    request: pytest.FixtureRequest, lsp_client: LanguageClient, tmp_path: Path, asked: list[str]
) -> AsyncIterator[None]:
    capabilities = client_capabilities(getattr(request, "param", "visual-studio-code"))
    general = capabilities.general or types.GeneralClientCapabilities()
    general.stale_request_support = types.StaleRequestSupportOptions(cancel=True, retry_on_content_modified=[TOKENS])
    capabilities.general = general
    await begin_session(lsp_client, tmp_path, capabilities, asked)
    yield
    await lsp_client.shutdown_session()


@pytest.fixture
def editor(client: LanguageClient, tmp_path: Path) -> Editor:
    return Editor(client, tmp_path)


async def state(editor: Editor) -> Any:
    return await editor.client.protocol.send_request_async("test/state", {})


async def refused(answer: Any) -> JsonRpcException:
    """Wait for an answer that is an error."""
    with pytest.raises(JsonRpcException) as caught:
        async with asyncio.timeout(PATIENCE):
            await answer
    return caught.value


async def hover(editor: Editor) -> types.Hover | None:
    params = types.HoverParams(**editor.at("var thing", after=True))
    return await editor.client.text_document_hover_async(params)


def ask_tokens(editor: Editor, request_id: str) -> Any:
    params = types.SemanticTokensParams(text_document=types.TextDocumentIdentifier(uri=editor.uri))
    return asyncio.ensure_future(editor.client.protocol.send_request_async(TOKENS, params, msg_id=request_id))


async def until_begun(editor: Editor) -> None:
    async with asyncio.timeout(PATIENCE):
        while (await state(editor)).begun == 0:
            await asyncio.sleep(0.01)


def sent_as_it_is(editor: Editor, message: dict[str, Any]) -> Any:
    """Send a request that the client's own types would refuse."""
    protocol = editor.client.protocol
    future: Future[Any] = Future()
    protocol._request_futures[message["id"]] = future  # pyright: ignore[reportPrivateUsage]
    protocol._send_data(message)  # pyright: ignore[reportPrivateUsage]
    return asyncio.wrap_future(future)


def cancel(editor: Editor, request_id: str) -> None:
    editor.client.protocol.notify(types.CANCEL_REQUEST, types.CancelParams(id=request_id))


@CLIENTS
async def test_an_internal_error_answers_its_request_and_is_logged_with_its_place(editor: Editor) -> None:
    editor.open(editor.text + "// planted fault\n")
    error = await refused(hover(editor))
    assert error.code == INTERNAL_ERROR
    assert error.message.startswith("internal error in textDocument/hover")
    assert "Traceback" not in f"{error.message}{error.data}"
    position = editor.at("var thing", after=True)["position"]
    log = Path((await state(editor)).log).read_text(encoding="utf-8")
    assert f"textDocument/hover {editor.uri}, line {position.line + 1}, character {position.character}" in log
    assert log.count("RuntimeError: planted fault in hover") == 1
    assert "Traceback (most recent call last)" in log

    editor.change("// planted fault\n", "")
    assert await hover(editor) is not None


async def test_an_error_in_the_background_thread_costs_one_answer_and_is_logged(editor: Editor) -> None:
    async def previewed() -> Any:
        return await editor.client.protocol.send_request_async("robbdd/preview", {"uri": editor.uri})

    editor.open(editor.text + "// planted fault\n")
    error = await refused(previewed())
    assert error.code == INTERNAL_ERROR
    assert error.message.startswith("internal error in robbdd/preview")
    log = Path((await state(editor)).log).read_text(encoding="utf-8")
    assert "robbdd/preview" in log
    assert editor.uri in log
    assert "RuntimeError: planted fault in preview" in log

    editor.change("// planted fault\n", "")
    assert (await previewed()).total > 0


async def test_an_error_behind_a_notification_is_logged_and_the_next_edit_is_answered(editor: Editor) -> None:
    editor.open(editor.text + "// planted defect\n")
    async with asyncio.timeout(PATIENCE):
        while "RuntimeError: planted defect" not in Path((await state(editor)).log).read_text(encoding="utf-8"):
            await asyncio.sleep(0.01)
    editor.change("// planted defect\n", "")
    await editor.diagnostics()
    assert editor.client.messages == []


async def test_parameters_that_cannot_be_read_are_answered(editor: Editor) -> None:
    editor.open()
    params = {"textDocument": {"uri": editor.uri}, "position": "here"}
    message = {"jsonrpc": "2.0", "id": "unreadable", "method": "textDocument/hover", "params": params}
    error = await refused(sent_as_it_is(editor, message))
    assert "parameters of textDocument/hover" in error.message
    assert await hover(editor) is not None


@CLIENTS
async def test_a_cancelled_request_is_answered_and_its_work_is_left(editor: Editor) -> None:
    editor.open(editor.text + "// endless\n")
    running, waiting = ask_tokens(editor, "running"), ask_tokens(editor, "waiting")
    await until_begun(editor)
    assert not running.done()
    assert not waiting.done()
    for name, answer in (("waiting", waiting), ("running", running)):
        cancel(editor, name)
        assert (await refused(answer)).code == REQUEST_CANCELLED
    # The thread is free again, and waiting work is never started.
    assert await hover(editor) is not None
    seen = await state(editor)
    assert (seen.begun, seen.left) == (1, 1)


async def test_a_text_that_moves_on_ends_what_the_client_asks_again(editor: Editor) -> None:
    editor.open(editor.text + "// endless\n")
    answer = ask_tokens(editor, "stale")
    await until_begun(editor)
    editor.change("// endless\n", "")
    assert (await refused(answer)).code == CONTENT_MODIFIED
    assert (await ask_tokens(editor, "fresh")).data


async def test_hover_waits_for_importers_for_a_moment_only_and_says_so(editor: Editor) -> None:
    await editor.client.protocol.send_request_async("test/hold", {})
    editor.open()
    found = await hover(editor)
    assert found is not None
    assert STILL_READING in str(found.contents)
    await editor.client.protocol.send_request_async("test/goOn", {})
    async with asyncio.timeout(PATIENCE):
        while (found := await hover(editor)) is None or STILL_READING in str(found.contents):
            pass


async def test_the_watchdog_sees_a_blocked_loop(editor: Editor) -> None:
    await state(editor)  # Forget what starting has cost.
    await editor.client.protocol.send_request_async("test/block", {})
    (blocked,) = (await state(editor)).blocked
    assert "s in <" in blocked


def large_model(text: str) -> str:
    """The example's text with many more stories: ten thousand lines."""
    story = text[text.index("User Story") :]
    copies = 10_000 // story.count("\n")
    return text + "".join(story.replace("tidy-bench", f"tidy-bench-{number}") for number in range(copies))


async def test_nothing_blocks_the_loop_while_a_large_file_is_edited_validated_and_run(editor: Editor) -> None:
    editor.open(large_model(editor.text))
    assert editor.text.count("\n") > 10_000
    await state(editor)  # Forget what starting has cost.
    document = types.TextDocumentIdentifier(uri=editor.uri)
    run = editor.client.workspace_execute_command_async(
        types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": editor.uri, "first": 1}])
    )
    for number in range(5):
        editor.change("var thing", "var thin g") if number % 2 == 0 else editor.change("var thin g", "var thing")
        await asyncio.gather(
            ask_tokens(editor, f"tokens-{number}"),
            editor.client.text_document_document_symbol_async(types.DocumentSymbolParams(text_document=document)),
            editor.client.text_document_completion_async(types.CompletionParams(**editor.at("var thin"))),
            editor.client.text_document_inlay_hint_async(
                types.InlayHintParams(text_document=document, range=editor.everything())
            ),
            editor.client.text_document_code_lens_async(types.CodeLensParams(text_document=document)),
            return_exceptions=True,
        )
    editor.change("var thin g", "var thing")
    await editor.client.workspace_execute_command_async(
        types.ExecuteCommandParams(command="robbdd.cancel", arguments=[{}])
    )
    await run
    assert (await state(editor)).blocked == []
