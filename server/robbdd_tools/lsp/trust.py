"""A workspace that is not trusted: nothing of it is run, and the code that a run would execute is named."""

from __future__ import annotations

import asyncio
import os
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.isolation import NO_USER_CODE, UNTRUSTED
from robbdd_tools.lsp.run_plan import ModelError, RunOptions, plan_run
from robbdd_tools.run.prepare import prepare_all
from robbdd_tools.run.user_code import refusal

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.run.prepare import RunRequest

_REFUSAL = "nothing was run, because this workspace is not trusted"
_WITHOUT_PLACES = f"{_REFUSAL}: scenarios run the workspace's own steps, behaviours and models"
_SEARCHED = 100
"""Scenarios that are searched for code: those of an execution share theirs, and a refusal has to be quick."""


def distrust() -> None:
    """Let no process that this one starts import code of users."""
    os.environ[NO_USER_CODE] = UNTRUSTED


async def refuse_run(ls: RobbddServer, argument: dict[str, Any]) -> str:
    """Return why the run that a command asks for is refused: with the places of its users' code, where it has any."""
    try:
        asked = RunOptions.of(argument)
        options = replace(asked, failed=False, sample=None, first=min(asked.first or _SEARCHED, _SEARCHED))
        plan = await ls.in_background(lambda snapshot: plan_run(snapshot, ls.convert, options, ()), options.uri)
        places = await asyncio.to_thread(_user_code, plan.request)
    except (ModelError, OSError):
        places = ""
    return f"{_REFUSAL}: {places}" if places else _WITHOUT_PLACES


def _user_code(request: RunRequest) -> str:
    with tempfile.TemporaryDirectory(prefix="robbdd-") as name:
        return refusal(prepare_all([request], request.name, request.seed, Path(name)), Path(name))
