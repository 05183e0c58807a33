"""Protect against untrusted workspaces.

Their code is never run, and a refusal names the code that a run would execute.
"""

from __future__ import annotations

import asyncio
import os
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.isolation import NO_USER_CODE, UNTRUSTED
from robbdd_tools.lsp.run_options import RunOptions

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

_REFUSAL = "nothing was run, because this workspace is not trusted"
_WITHOUT_PLACES = f"{_REFUSAL}: scenarios run the workspace's own steps, behaviours and models"
_SEARCHED = 100
"""Maximum scenarios searched for code: scenarios of one execution share their code, and a refusal must be quick."""


def forbid_user_code() -> None:
    """Forbid all processes that are started from here to import users' code."""
    os.environ[NO_USER_CODE] = UNTRUSTED


async def refuse_run(ls: RobbddServer, argument: dict[str, Any]) -> str:
    """Return the reason why a requested run is refused, with the places of its users' code if it has any."""
    from robbdd_tools.lsp.run_request import plan_run
    from robbdd_tools.run.user_code import UserCodeRefused
    from robbdd_tools.workbench.run import check_user_code

    try:
        asked = RunOptions.of(argument)
        first = min(asked.first or _SEARCHED, _SEARCHED)
        options = replace(asked, failed=False, sample=None, pairwise=None, first=first)
        planned = await ls.in_background(lambda snapshot: plan_run(snapshot, ls.convert, options, ()), options.uri)
        await asyncio.to_thread(check_user_code, planned.plan)
    except UserCodeRefused as refused:
        return f"{_REFUSAL}: {refused}"
    except (RobbddError, OSError):
        pass
    return _WITHOUT_PLACES
