"""Commands start as forks."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from fork_kit import fork_server


@pytest.fixture(scope="session", autouse=True)
def forks() -> Iterator[None]:
    with fork_server():
        yield
