"""Limits are set by the user: by the environment and the editor's setting."""

from __future__ import annotations

import pytest

from kit import DOCS
from robbdd_tools.base.limits import LIMITS, MODEL_SIZE, use_limits


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> None:
    for limit in LIMITS.values():
        monkeypatch.setenv(limit.variable, "")


@pytest.mark.parametrize("stated", ["", "0", "-1", "1.5", "many", "²", "9" * 30])
def test_a_variable_that_is_no_positive_number_is_ignored(monkeypatch: pytest.MonkeyPatch, stated: str) -> None:
    monkeypatch.setenv(MODEL_SIZE.variable, stated)
    assert MODEL_SIZE.value() == MODEL_SIZE.default


def test_the_editors_setting_counts_until_it_is_gone() -> None:
    assert use_limits({"model-size": 100}) is None
    assert MODEL_SIZE.value() == 100
    assert use_limits(None) is None
    assert MODEL_SIZE.value() == MODEL_SIZE.default


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ({"model": 1}, "has no limit 'model'; there are model-size"),
        ({"model-size": "1"}, "must be a positive whole number of bytes"),
        ({"model-size": True}, "must be a positive whole number of bytes"),
        ({"scanned-depth": 0}, "must be a positive whole number of levels of folders"),
        ([], "must be an object"),
    ],
)
def test_a_wrong_setting_is_explained_and_changes_nothing(stated: object, words: str) -> None:
    assert words in (use_limits(stated) or "")
    assert MODEL_SIZE.value() == MODEL_SIZE.default


def test_every_limit_is_documented_with_its_variable() -> None:
    page = (DOCS / "limits.md").read_text(encoding="utf-8")
    for name, limit in LIMITS.items():
        assert f"| `{name}`: " in page
        assert f"`{limit.variable}`" in page
