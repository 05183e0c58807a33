"""What all tests of campaigns share."""

from __future__ import annotations

import pytest

from robbdd_tools.base.isolation import NO_USER_CODE


@pytest.fixture(autouse=True)
def _restored_consent(monkeypatch: pytest.MonkeyPatch) -> None:  # pyright: ignore[reportUnusedFunction]
    """A worker of a cluster forbids users' code in its process, which is the one of the tests here."""
    monkeypatch.setenv(NO_USER_CODE, "")
