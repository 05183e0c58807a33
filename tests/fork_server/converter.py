"""A converter between messages and JSON for all servers and clients of a process.

It compiles a function for each type of message that it meets for the first time, which takes longer than most tests.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from lsprotocol.types import METHOD_TO_TYPES
from pygls.protocol import default_converter

FACTORY = "pytest_lsp.client.default_converter"
"""Where a client of a test gets its converter."""


@cache
def shared_converter() -> Any:
    return default_converter()


def compile_all() -> None:
    """Compile the functions for the messages of the protocol."""
    converter = shared_converter()
    for messages in METHOD_TO_TYPES.values():
        for message in messages[:3]:
            if message is not None:
                converter.get_structure_hook(message)
                converter.get_unstructure_hook(message)
