"""Plots of margins: well-formed, within their bounds, with what decides marked."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

from robbdd_tools.run.plot import BAD, GOOD, HEIGHT, WIDTH, plot

SVG = "{http://www.w3.org/2000/svg}"


def kept(**changes: Any) -> dict[str, Any]:
    part = {
        "start": 2.0,
        "end": 4.0,
        "reason": "",
        "unit": "m",
        "negated": False,
        "times": [0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
        "margins": [-0.5, 0.1, 0.2, -0.03, 0.1, 0.3],
        **changes,
    }
    events = [{"name": "t:evt-pick-start", "time": 2.0}, {"name": "t:evt-<&>", "time": 4.0}]
    return {"duration": 5.0, "events": events, "clauses": {"7": [part], "8": []}}


def drawn(**changes: Any) -> ElementTree.Element:
    found = plot(kept(**changes), 7)
    assert found is not None
    return ElementTree.fromstring(found)


def test_the_least_margin_within_the_window_is_marked() -> None:
    picture = drawn()
    (mark,) = picture.iter(f"{SVG}circle")
    assert mark.get("fill") == BAD
    (line,) = picture.iter(f"{SVG}polyline")
    points = [tuple(map(float, point.split(","))) for point in str(line.get("points")).split()]
    assert points[3] == (float(str(mark.get("cx"))), float(str(mark.get("cy"))))
    assert all(0 <= x <= WIDTH and 0 <= y <= HEIGHT for x, y in points)
    texts = [text.text for text in picture.iter(f"{SVG}text")]
    assert {"pick-start", "<&>", "−500 mm", "+300 mm", "5.00 s"} <= set(texts)


def test_the_fluent_that_decides_is_plotted() -> None:
    clause = kept()
    (part,) = clause["clauses"]["7"]
    clause["clauses"]["7"] = [{**part, "margins": [-1.0] * 6, "unit": ""}, part]
    chosen, other = plot(clause, 7, 1), plot(clause, 7, 0)
    assert chosen == plot(kept(), 7)
    assert chosen != other


def test_a_negated_clause_wants_the_opposite() -> None:
    assert [mark.get("fill") for mark in drawn(negated=True).iter(f"{SVG}circle")] == [GOOD]


def test_the_largest_margin_is_marked_where_one_sample_suffices() -> None:
    for negated, color in ((False, GOOD), (True, BAD)):
        picture = drawn(some_time=True, negated=negated)
        (mark,) = picture.iter(f"{SVG}circle")
        (line,) = picture.iter(f"{SVG}polyline")
        assert f"{mark.get('cx')},{mark.get('cy')}" == str(line.get("points")).split()[2]
        assert mark.get("fill") == color


def test_without_a_window_there_is_a_curve_alone() -> None:
    picture = drawn(start=None, end=None)
    assert not list(picture.iter(f"{SVG}circle")) + list(picture.iter(f"{SVG}rect"))


def test_a_constant_margin_can_be_drawn() -> None:
    assert drawn(margins=[0.0] * 6) is not None


def test_where_nothing_is_recorded_there_is_no_plot() -> None:
    assert plot(kept(times=[], margins=[]), 7) is None
    assert plot(kept(), 8) is None
    assert plot(kept(), 9) is None
