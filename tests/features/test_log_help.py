"""Completion and hover of the names in a log, from the summary that the background process has made."""

from __future__ import annotations

from pathlib import Path

import pytest

from logs.named_drive import cell, named, opened
from robbdd_tools.features.completion import complete
from robbdd_tools.features.hover import hover
from robbdd_tools.logs.summary_cache import obtain

PROVIDER = "\nobs provider (ns=exec) camera {{ ros {} }}\n"


def proposed(path: Path, text: str) -> dict[str, str]:
    """Return the labels and facts of the proposals at the cursor ``$0`` in a text."""
    offset = text.index("$0")
    path.write_text(text.replace("$0", ""), encoding="utf-8")
    snapshot, uri = opened(path)
    return {one.label: one.detail for one in complete(snapshot, uri, offset)}


@pytest.fixture
def read(tmp_path: Path) -> Path:
    """A cell whose log has been read."""
    path = cell(tmp_path, named())
    obtain(path.with_name("drive"))
    return path


@pytest.mark.parametrize(
    ("entries", "labels"),
    [
        ('frames: { "$0" to obj <cubes.cube0> }', ["bin_left", "bin_right", "cube0", "map", "panda", "table"]),
        ('world frame: "$0"', ["bin_left", "bin_right", "cube0", "map", "panda", "table"]),
        ('events: { <evt-pick-end> when "$0" }', ["/events", "/panda/holds", "/tf", "/tf_static"]),
        ('events: { <evt-pick-end> when "/ev$0" }', ["/events", "/panda/holds", "/tf", "/tf_static"]),
        ('events: { <evt-pick-end> when "/events.$0 is x" }', ["data"]),
        ('grips: { <arms.panda> while "$0" }', ["/events", "/panda/holds", "/tf", "/tf_static"]),
    ],
)
def test_the_names_of_the_log_are_proposed(entries: str, labels: list[str], read: Path) -> None:
    assert list(proposed(read, named(entries))) == labels


def test_types_and_topics_of_the_log_are_proposed_at_providers(read: Path) -> None:
    topics = proposed(read, named() + PROVIDER.format('topic: "$0" type: "x"'))
    assert topics["/events"] == "std_msgs/msg/String, 4 messages, 0.4 Hz"
    assert list(proposed(read, named() + PROVIDER.format('topic: "/events" type: "$0"'))) == ["std_msgs/msg/String"]
    frame = proposed(read, named() + PROVIDER.format('transform listener reference-frame: "$0" update-rate: 3 Hz'))
    assert frame["cube0"] == "in map, 501 poses, 50 Hz, from 0.00 s to 10.00 s"


def test_an_unread_log_proposes_nothing(tmp_path: Path) -> None:
    assert proposed(cell(tmp_path, ""), named('frames: { "$0" to obj <cubes.cube0> }')) == {}


def test_logs_are_proposed_as_paths(read: Path) -> None:
    assert {"drive/", "pickplace.bdd"} & set(proposed(read, named(path="$0"))) == {"drive/"}


@pytest.mark.parametrize(
    ("at", "words"),
    [
        ('"cube0" to', "**frame** `cube0`\n\nin map, 501 poses, 50 Hz, from 0.00 s to 10.00 s"),
        ('"/events becomes', "**topic** `/events`\n\nstd\\_msgs/msg/String, 4 messages, 0.4 Hz"),
        ('"drive"', "**log** of 10.00 s"),
    ],
)
def test_hover_shows_type_rate_and_period(at: str, words: str, read: Path) -> None:
    text = named('frames: { "cube0" to obj <cubes.cube0> } events: { <evt-pick-end> when "/events becomes x" }')
    read.write_text(text, encoding="utf-8")
    snapshot, uri = opened(read)
    shown = hover(snapshot, uri, text.index(at) + 2)
    assert shown is not None
    assert words.replace("\\", "") in shown.markdown.replace("\\", "")
