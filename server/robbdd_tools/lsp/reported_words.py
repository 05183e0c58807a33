"""Report words of other packages that the catalog leaves out."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from lsprotocol import types

from robbdd_tools.catalog.registry import load_catalog

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


async def report_words(ls: RobbddServer) -> None:
    """Show a message for each such word, with its package and the reason."""
    catalog = await asyncio.to_thread(load_catalog)
    for problem in catalog.problems:
        ls.warn(problem, types.MessageType.Warning)
