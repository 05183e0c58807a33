"""The protocol of pygls, with serialisation in a separate thread instead of the event loop."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable, Generator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, cast

from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInternalError, JsonRpcInvalidParams, JsonRpcInvalidRequest
from pygls.protocol import LanguageServerProtocol, lsp_method
from pygls.protocol.json_rpc import JsonRPCNotification

from robbdd_tools.base.spellings import Spellings
from robbdd_tools.base.uris import canonical_uri
from robbdd_tools.lsp.json_text import JsonText
from robbdd_tools.lsp.open_texts import OpenTexts
from robbdd_tools.lsp.transport import end_soon

_LOG = logging.getLogger(__name__)
_Steps = Generator[Any, Any, None]
"""The handlers that pygls calls for a message, with their arguments."""
_DOCUMENTS = frozenset((types.TEXT_DOCUMENT_DID_OPEN, types.TEXT_DOCUMENT_DID_CHANGE, types.TEXT_DOCUMENT_DID_CLOSE))
"""Notifications about a document that the client names. While the document is open, its URI identifies the file."""


class Protocol(LanguageServerProtocol):
    """Sends messages in the order in which they are submitted."""

    def __init__(self, *arguments: Any) -> None:
        self.texts = OpenTexts()
        super().__init__(*arguments)
        self._outbox = ThreadPoolExecutor(1, thread_name_prefix="outbox")

    @lsp_method(types.EXIT)
    def lsp_exit(self, *arguments: Any) -> Generator[Any, Any, None]:
        """End the server after everything is sent.

        If the client does not read, or if work does not end, the server ends immediately.
        """
        end_soon(self.exit_code)
        self._outbox.shutdown(wait=True)
        yield from super().lsp_exit(*arguments)  # pyright: ignore[reportUnknownMemberType] -- no types in pygls

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> _Steps:
        """Take the text of a document."""
        self.texts.open(params.text_document.uri, params.text_document.text)
        yield self._handler(types.TEXT_DOCUMENT_DID_OPEN), (params,), None

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> _Steps:
        """Change the text of a document at once, so that later messages see it."""
        # pygls declares the base class of the server only.
        server: Any = self._server
        self.texts.change(server.convert, params.text_document.uri, params.content_changes)
        yield self._handler(types.TEXT_DOCUMENT_DID_CHANGE), (params,), None

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> _Steps:
        """Drop the text of a document."""
        self.texts.close(params.text_document.uri)
        yield self._handler(types.TEXT_DOCUMENT_DID_CLOSE), (params,), None

    def _handler(self, method: str) -> Any:
        # pygls leaves the type of the features open.
        manager: Any = self.fm
        return manager.features[method]

    @property
    def exit_code(self) -> int:
        """The exit code of the process, as specified: 0 if the client has requested ``shutdown``, otherwise 1."""
        return 0 if self._shutdown else 1

    def handle_message(self, message: Any) -> None:
        """Handle a message. After ``shutdown``, every request is refused."""
        if self._shutdown and hasattr(message, "id") and hasattr(message, "method"):
            self._send_response(message.id, error=self._late().to_response_error())
        elif getattr(message, "method", "") == types.EXIT:
            self._exit(message)
        else:
            super().handle_message(message)

    def _exit(self, message: Any, turns: int = 100) -> None:
        """Handle ``exit`` after the answers that are ready have been sent, for example the answer to ``shutdown``."""
        if turns and self._request_futures:
            asyncio.get_running_loop().call_soon(self._exit, message, turns - 1)
        else:
            super().handle_message(message)

    def _late(self) -> JsonRpcException:
        return JsonRpcInvalidRequest("the server is shut down: only 'exit' may follow")

    def structure_message(self, data: dict[str, Any]) -> Any:
        """Parse a message. A request with invalid parameters is answered here, because pygls does not answer it.

        pygls also calls this for each object inside a message, before the message.
        """
        if "jsonrpc" not in data:
            return data
        try:
            return super().structure_message(self._with_our_uris(data))
        except JsonRpcException as error:
            if "id" in data and "method" in data:
                reason = f"the parameters of {data['method']} do not match the protocol"
                refusal = self._late() if self._shutdown else JsonRpcInvalidParams(reason)
                self._send_response(data["id"], error=refusal.to_response_error())
            _LOG.warning("%s cannot be read: %s", data.get("method", "a response"), error)
            return JsonRPCNotification(method="$/unreadable", jsonrpc=self.VERSION, params=None)

    def _with_our_uris(self, data: dict[str, Any]) -> dict[str, Any]:
        """Return a message in which each file has the URI that the server uses for it."""
        # pygls declares the base class of the server only.
        server: Any = self._server
        spellings: Spellings = server.project.spellings
        method = data.get("method")
        if method not in _DOCUMENTS:
            return with_canonical_uris(data, spellings.of)
        message = with_canonical_uris(data)
        uri = _document(message)
        if method == types.TEXT_DOCUMENT_DID_OPEN and uri is not None:
            # Requests may already be queued after this message.
            spellings.open(uri)
        return message

    def _execute_handler(
        self, msg_id: Any, handler: Any, callback: Any, args: Any = None, kwargs: dict[str, Any] | None = None
    ) -> None:
        """Call a handler and drop its future when it is done.

        Otherwise pygls would keep the futures of notifications for ever.
        """
        super()._execute_handler(msg_id, handler, callback, args, kwargs)
        future = self._request_futures.get(msg_id)
        if future is None:
            return

        def drop() -> None:
            if self._request_futures.get(msg_id) is future:
                del self._request_futures[msg_id]

        # Not immediately: on shutdown, pygls cancels all futures while it iterates over them.
        loop = asyncio.get_running_loop()
        future.add_done_callback(lambda _: loop.call_soon(drop))

    def serialised(self, value: Any) -> str:
        """Return a value of the protocol as JSON text, as pygls would send it."""
        return json.dumps(value, default=self._serialize_message)

    def _send_response(self, msg_id: Any, result: Any | None = None, error: Any | None = None) -> None:
        if error is not None or not isinstance(result, JsonText):
            super()._send_response(msg_id, result, error)
            return
        self._result_types.pop(msg_id, None)
        text = f'{{"id": {json.dumps(msg_id)}, "jsonrpc": "{self.VERSION}", "result": {result.text}}}'
        self._submit(self._write_text, text)

    def _send_data(self, data: Any) -> None:
        self._submit(self._write, data)

    def _submit(self, write: Callable[[Any], None], data: Any) -> None:
        try:
            self._outbox.submit(write, data)
        except RuntimeError:
            # The session has ended: all earlier messages are written.
            write(data)

    def _write(self, data: Any) -> None:
        super()._send_data(data)

    def _write_text(self, text: str) -> None:
        """Send a message that is already serialised, with the same header as pygls."""
        body = text.encode(self.CHARSET)
        header = f"Content-Length: {len(body)}\r\nContent-Type: {self.CONTENT_TYPE}; charset={self.CHARSET}\r\n\r\n"
        try:
            # The server writes to streams without event loop only.
            writer: Any = self.writer
            writer.write(header.encode(self.CHARSET) + body)
        except Exception as error:
            # As pygls does; its base class of servers declares no public method for this.
            server: Any = self._server
            server.report_server_error(error, JsonRpcInternalError)


def with_canonical_uris(message: Any, spelling: Callable[[str], str] = str) -> Any:
    """Return a message in which each file has one canonical URI. The texts of documents are not changed.

    ``spelling`` chooses among the URIs of the same file. The new URI of a file that is renamed is not replaced: only
    upper and lower case letters may change.
    """
    match message:
        case str():
            uri = canonical_uri(message)
            return spelling(uri) if uri.startswith("file:") else uri
        case dict():
            fields = cast("dict[str, Any]", message)
            return {name: _field(name, value, spelling) for name, value in fields.items()}
        case list():
            return [with_canonical_uris(entry, spelling) for entry in cast("list[Any]", message)]
        case _:
            return message


def _document(message: Any) -> str | None:
    match message:
        case {"params": {"textDocument": {"uri": str(uri)}}}:
            return uri
        case _:
            return None


def _field(name: str, value: Any, spelling: Callable[[str], str]) -> Any:
    match name:
        case "text":
            return value
        case "newUri":
            return with_canonical_uris(value)
        case _:
            return with_canonical_uris(value, spelling)
