"""``robbdd-lsp``: start the language server over standard input and output, or for a client at a TCP address."""

from __future__ import annotations

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools import __version__
from robbdd_tools.lsp.stdio import StdioConnection
from robbdd_tools.lsp.tcp import TcpConnection, accept_client
from robbdd_tools.lsp.transport import RefusalFilter, end_soon

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

LOOPBACK = "127.0.0.1"
LARGEST_PORT = 65535


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the server until its client ends it. Return the exit code."""
    parser = argparse.ArgumentParser("robbdd-lsp", description="Language server for RobBDD models.")
    parser.add_argument("--version", action="version", version=f"robbdd-lsp {__version__}")
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--stdio", action="store_true", help="talk over standard input and output (the default)")
    way.add_argument(
        "--tcp",
        type=address,
        metavar="[HOST:]PORT",
        help="wait for one client at this address; without a host, on loopback only",
    )
    parser.add_argument("--log-file", type=Path, metavar="FILE", help="write a log to this file")
    options = parser.parse_args(arguments)
    try:
        _log_to(options.log_file)
    except OSError as error:
        parser.error(f"the log cannot be written to {options.log_file}: {error.strerror or error}")

    server = load_server()
    if options.tcp is None:
        server.start_connection(StdioConnection())
    else:
        try:
            client = accept_client(*options.tcp)
        except OSError as error:
            host, port = options.tcp
            reason = os.strerror(error.errno) if error.errno and error.errno > 0 else error.strerror or error
            parser.error(f"no client can connect to {host}:{port}: {reason}")
        server.start_connection(TcpConnection(client))
    server.stop()
    code = server.exit_code()
    end_soon(code)
    return code


def load_server() -> RobbddServer:
    """Import the server and everything that it needs, and return it."""
    from robbdd_tools.base.deferred_methods import deferred_methods
    from robbdd_tools.base.memory import collect_rarely, freeze_garbage_collection

    with freeze_garbage_collection(), deferred_methods():
        from robbdd_tools.lsp.handlers import create_server

        server = create_server()
    collect_rarely()
    return server


def address(text: str) -> tuple[str, int]:
    """Return the host and the port in ``PORT`` or ``HOST:PORT``. Raises ``ArgumentTypeError`` for any other text."""
    host, colon, port = text.rpartition(":")
    if not port.isdecimal() or int(port) > LARGEST_PORT or (colon and not host):
        raise argparse.ArgumentTypeError(f"'{text}' is not an address: write PORT or HOST:PORT, such as 2087")
    return host.strip("[]") or LOOPBACK, int(port)


def _log_to(file: Path | None) -> None:
    """Write all log records to a file or, without one, warnings to standard error.

    Standard output is not used, because it belongs to the protocol.
    """
    handler = logging.StreamHandler(sys.stderr) if file is None else logging.FileHandler(file, encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    handler.addFilter(RefusalFilter())
    logging.getLogger().addHandler(handler)
    # pygls warns about every cancelled request that was already answered, which is normal for editors.
    logging.getLogger("pygls").setLevel(logging.ERROR)
    logging.getLogger("robbdd_tools").setLevel(logging.WARNING if file is None else logging.DEBUG)


if __name__ == "__main__":
    sys.exit(main())
