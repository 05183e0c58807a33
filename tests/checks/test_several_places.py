"""An object that should be at each of several places apart is reported, with how to write any of them."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import MODEL, SCENE

SORTING = MODEL.replace("    var goal\n", "    var goal\n    set var goals\n").replace(
    "in-tray: holds(<part> is located at <goal>,", "in-tray: holds(<part> is located at <goals>,"
)
BIN = "comp (ns=env) bin_comp of ws <places.bin_ws> { obj <furniture.bin> }\n"
APART = (
    SCENE.replace("tray }", "tray, object bin }")
    .replace("workspace tray_ws", "workspace tray_ws, workspace bin_ws")
    .replace(
        "comp (ns=env) bench",
        "comp (ns=env) bin_comp of ws <places.bin_ws> { obj <furniture.bin> }\ncomp (ns=env) bench",
    )
    .replace("ws comp <tray_comp> agn", "ws comp <tray_comp> ws comp <bin_comp> agn")
)


def model(values: str, text: str = SORTING, scene: str = APART) -> str:
    line = f"set var <fetch.goals>: {values}\n                var <fetch.goal>"
    return "//- main.bdd\n" + text.replace("var <fetch.goal>", line) + f"//- lab.scene\n{scene}"


def messages(values: str, text: str = SORTING, scene: str = APART) -> list[str]:
    return [one.message for one in found(model(values, text, scene), "several-places")]


@pytest.mark.parametrize(
    "values",
    [
        "{ { <places.tray_ws>, <places.bin_ws> } }",
        "{ { <places.tray_ws> }, { <places.bin_ws>, <places.tray_ws> } }",
        "select 2 combinations from <places>",
    ],
)
def test_places_apart_are_named_with_what_to_write(values: str) -> None:
    (message,) = messages(values)
    assert message.startswith("'part' cannot be located at each of 'goals', because '")
    assert "( var place exists in <goals> ) such that { … <part> is located at <place> … }" in message


@pytest.mark.parametrize(
    "values",
    [
        "{ { <places.tray_ws> }, { <places.bin_ws> } }",
        "select 1 combinations from <places>",
        "{ { <places.bench_ws>, <places.tray_ws> } }",
    ],
)
def test_one_place_or_one_in_the_other_is_possible(values: str) -> None:
    assert messages(values) == []


def test_two_workspaces_of_one_object_are_possible() -> None:
    scene = APART.replace("<furniture.bin> }", "<furniture.tray> }")
    assert messages("{ { <places.tray_ws>, <places.bin_ws> } }", scene=scene) == []


def test_any_of_them_is_possible() -> None:
    text = SORTING.replace(
        "in-tray: holds(<part> is located at <goals>, 0.5 seconds after <place-end>)",
        "( var place exists in <goals> ) such that { in-tray: holds(<part> is located at <place>, after <place-end>) }",
    )
    assert text != SORTING
    assert messages("{ { <places.tray_ws>, <places.bin_ws> } }", text) == []


def test_a_clause_of_a_variant_is_reported_in_the_story() -> None:
    text = MODEL.replace("    var goal\n", "    var goal\n    set var goals\n").replace(
        " variation:", " Then: extra: holds(<fetch.part> is located at <fetch.goals>, after <place-end>)\n variation:"
    )
    (one,) = found(model("{ { <places.tray_ws>, <places.bin_ws> } }", text), "several-places")
    assert "'fetch.part' cannot be located at each of 'fetch.goals'" in one.message


def test_a_thing_that_should_be_entirely_inside_each_of_several_places_is_reported() -> None:
    text = SORTING.replace("<part> is located at <goals>,", "<part> is entirely inside <goals>,")
    (message,) = messages("{ { <places.tray_ws>, <places.bin_ws> } }", text)
    assert message.startswith("'part' cannot be entirely inside each of 'goals', because 'tray_ws' and 'bin_ws' have")
    assert "{ … <part> is entirely inside <place> … }" in message
