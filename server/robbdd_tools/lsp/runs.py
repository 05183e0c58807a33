"""Runs from the editor, one at a time. The workbench plans and executes them, and ``run_follower`` shows them."""

from __future__ import annotations

import asyncio
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.lsp.active_run import ActiveRun
from robbdd_tools.lsp.document_models import reason
from robbdd_tools.lsp.result_hover import picture_violations
from robbdd_tools.lsp.run_follower import RunFollower
from robbdd_tools.lsp.run_options import RunOptions
from robbdd_tools.lsp.run_request import PlannedRun, RunText, plan_run
from robbdd_tools.lsp.trust import refuse_run
from robbdd_tools.run.debugging import check_debugger, free_port
from robbdd_tools.run.pictures import NoPictures, render_violations
from robbdd_tools.workbench.judged_scenarios import project_of
from robbdd_tools.workbench.rerun import NothingFailed
from robbdd_tools.workbench.run import begin_run
from robbdd_tools.workbench.time_estimate import estimate

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.run import Run

PICTURES = "pictures"
_BUSY = "a run is in progress: cancel it first"


async def start_run(ls: RobbddServer, argument: dict[str, Any], **more: object) -> dict[str, Any]:
    """Execute scenarios to the end and show their results. Return a summary, or the reason why nothing was run."""
    if not ls.trusted:
        return _refused(ls, await refuse_run(ls, {**argument, **more}))
    if ls.run is not None:
        return _refused(ls, _BUSY, momentary=True)
    try:
        options = RunOptions.of({**argument, **more})
        ls.run = active = ActiveRun(options, f"robbdd-run-{next(ls.run_numbers)}")
        run, text = await _begin(ls, options)
        async with run:
            active.execute(run)
            follower = RunFollower(ls, active, text, run)
            await follower.follow()
        pictures = await _record(ls, run.place) if options.record else []
        if ls.shows_pictures:
            await asyncio.to_thread(picture_violations, run.place, list(active.judged.values()))
        stored = {"run": run.number, "folder": path_to_uri(run.folder)}
        return {**follower.summary(), "stored": stored, "pictures": pictures}
    except (RobbddError, OSError) as error:
        return _refused(ls, reason(error), momentary=isinstance(error, NothingFailed))
    finally:
        ls.run = None


async def estimate_run(ls: RobbddServer, argument: dict[str, Any]) -> dict[str, Any]:
    """Return the estimated duration of a run, or the reason why it cannot be run. Nothing is executed."""
    try:
        options = RunOptions.of(argument)
        planned = await _planned(ls, options)
        scenarios, database = planned.plan.specs(repeat=planned.repeat), ls.stores.of(options.uri).database
        found = await asyncio.to_thread(estimate, scenarios, database, options.jobs)
    except (RobbddError, OSError) as error:
        return {"problem": reason(error)}
    return {**asdict(found), "words": str(found)}


async def _planned(ls: RobbddServer, options: RunOptions) -> PlannedRun:
    project = project_of(options.uri)
    results = [scenario for scenario in ls.results if scenario.project == project]
    defaults = ls.settings.run_defaults(options.uri)
    return await ls.in_background(
        lambda snapshot: plan_run(snapshot, ls.convert, options, results, defaults), options.uri
    )


async def _begin(ls: RobbddServer, options: RunOptions) -> tuple[Run, RunText]:
    """Plan a run on the texts of open files, and prepare its folder. Raises ``RobbddError`` and ``OSError``."""
    if options.debug:
        check_debugger()
    planned = await _planned(ls, options)
    place, remark = await asyncio.to_thread(ls.stores.begin, options.uri)
    if remark:
        ls.warn(remark)
    run = await asyncio.to_thread(
        begin_run,
        planned.plan,
        place,
        repeat=planned.repeat,
        jobs=options.jobs,
        stop_on_failure=options.stop_on_failure,
        debug=free_port() if options.debug else None,
    )
    return run, planned.text


def _refused(ls: RobbddServer, problem: str, *, momentary: bool = False) -> dict[str, Any]:
    """Show the reason why nothing was run. ``momentary`` is true if the reason is unrelated to the scenarios."""
    ls.warn(problem)
    return {"problem": problem, "momentary": True} if momentary else {"problem": problem}


async def _record(ls: RobbddServer, place: StoredRun) -> list[str]:
    """Render the violations of a run into its folder. Return the URIs of the pictures."""
    pictures = place.folder / PICTURES
    try:
        await asyncio.to_thread(render_violations, place.folder, pictures)
    except NoPictures as error:
        ls.warn(f"there are no pictures: {error}")
        return []
    return [path_to_uri(path) for path in sorted(pictures.glob("*.png"))]
