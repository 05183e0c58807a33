"""Report words of other packages that the catalog leaves out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.lsp.analysis_thread import Urgency

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


async def report_words(ls: RobbddServer) -> None:
    """Show a message for each word that is left out, with its package and the reason."""
    # Not in a thread of its own: both threads would read the catalog, since the first edit needs it, too.
    catalog = await ls.analyse(lambda _: load_catalog(), Urgency.IDLE)
    for problem in catalog.problems:
        ls.warn(problem, types.MessageType.Warning)
