"""A newer task replaces an older one of its key, but some task always finishes."""

from __future__ import annotations

import asyncio

from robbdd_tools.lsp.latest_wins import MAX_REPLACED, LatestWins


class Bench:
    """Numbered tasks that wait until released, and their outcomes."""

    def __init__(self) -> None:
        self.newest = LatestWins(asyncio.create_task)
        self.go = asyncio.Event()
        self.begun: list[int] = []
        self.finished: list[int] = []

    async def begin(self, number: int, key: str = "file") -> None:
        async def work() -> None:
            self.begun.append(number)
            await self.go.wait()
            self.finished.append(number)

        self.newest.begin(key, work)
        await self.settle()

    async def settle(self) -> None:
        """Let all that can go on do so: to be started, to be cancelled, to be followed by the next."""
        for _ in range(5):
            await asyncio.sleep(0)

    async def let_go(self) -> None:
        self.go.set()
        await self.settle()


async def test_a_newer_work_replaces_the_older() -> None:
    bench = Bench()
    await bench.begin(1)
    await bench.begin(2)
    await bench.begin(3, key="other")
    await bench.let_go()
    assert bench.finished == [2, 3]


async def test_one_work_is_let_through_and_the_last_one_follows_it() -> None:
    bench = Bench()
    last = 5 * MAX_REPLACED
    for number in range(last + 1):
        await bench.begin(number)
    assert bench.begun == list(range(MAX_REPLACED + 1))
    await bench.let_go()
    assert bench.finished == [MAX_REPLACED, last]


async def test_works_may_be_replaced_again_once_one_was_let_through() -> None:
    bench = Bench()
    for number in range(MAX_REPLACED + 1):
        await bench.begin(number)
    await bench.let_go()
    bench.go.clear()
    await bench.begin(100)
    await bench.begin(101)
    await bench.let_go()
    assert bench.finished == [MAX_REPLACED, 101]


async def test_what_is_ended_neither_goes_on_nor_is_followed() -> None:
    bench = Bench()
    for number in range(MAX_REPLACED + 2):
        await bench.begin(number)
    bench.newest.end("file")
    await bench.let_go()
    assert bench.finished == []
