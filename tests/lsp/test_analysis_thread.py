"""The analysis thread abandons superseded work, and only that."""

import asyncio
import threading
from collections.abc import Callable

import pytest

from robbdd_tools.base.checkpoint import Abandoned, checkpoint
from robbdd_tools.lsp.analysis_thread import AnalysisThread, Urgency


class Steps:
    """Work in two steps with a checkpoint between them, which waits there until it may go on."""

    def __init__(self) -> None:
        self.begun = threading.Event()
        self.go_on = threading.Event()

    def __call__(self) -> str:
        """Do it."""
        self.begun.set()
        self.go_on.wait()
        checkpoint()
        return "whole"


async def _begun(steps: Steps, thread: AnalysisThread) -> asyncio.Task[str]:
    task = asyncio.create_task(thread.do(steps, replacing="a.bdd"))
    await asyncio.to_thread(steps.begun.wait)
    return task


async def _queued(thread: AnalysisThread, work: Callable[[], str], replacing: str | None) -> asyncio.Task[str]:
    task = asyncio.create_task(thread.do(work, replacing=replacing))
    # Its first step puts the work into the queue.
    await asyncio.sleep(0)
    return task


async def test_an_edit_is_left_for_the_next_one_of_its_document() -> None:
    thread, steps = AnalysisThread(), Steps()
    first = await _begun(steps, thread)
    second = await _queued(thread, lambda: "newer", "a.bdd")
    steps.go_on.set()
    with pytest.raises(Abandoned):
        await first
    assert await second == "newer"
    thread.stop()


async def test_an_edit_is_not_left_for_one_of_another_document() -> None:
    thread, steps = AnalysisThread(), Steps()
    first = await _begun(steps, thread)
    second = await _queued(thread, lambda: "other", "b.bdd")
    steps.go_on.set()
    assert (await first, await second) == ("whole", "other")
    thread.stop()


async def test_what_is_asked_between_two_edits_sees_the_first() -> None:
    thread, steps = AnalysisThread(), Steps()
    first = await _begun(steps, thread)
    asked = await _queued(thread, lambda: "asked", None)
    second = await _queued(thread, lambda: "newer", "a.bdd")
    steps.go_on.set()
    assert (await first, await asked, await second) == ("whole", "asked", "newer")
    thread.stop()


async def test_the_end_of_the_session_cancels_running_work() -> None:
    analysis = AnalysisThread()
    began, stopped = threading.Event(), threading.Event()

    def work() -> None:
        began.set()
        stopped.wait()
        checkpoint()

    asked = asyncio.create_task(analysis.do(work, Urgency.LATER))
    await asyncio.to_thread(began.wait)
    analysis.stop()
    stopped.set()
    with pytest.raises(asyncio.CancelledError):
        await asked


async def test_idle_work_waits_for_later_work_and_is_interrupted_by_it() -> None:
    thread, steps, order = AnalysisThread(), Steps(), list[str]()

    def interrupted() -> None:
        steps()
        order.append("idle")

    first = asyncio.create_task(thread.do(interrupted, Urgency.IDLE))
    await asyncio.to_thread(steps.begun.wait)
    others = [
        asyncio.create_task(thread.do(lambda name=urgency.name: order.append(name), urgency))
        for urgency in (Urgency.IDLE, Urgency.LATER, Urgency.URGENT)
    ]
    await asyncio.sleep(0)
    steps.go_on.set()
    await asyncio.gather(first, *others)
    assert order == ["URGENT", "LATER", "idle", "IDLE"]
    thread.stop()
