"""Workspaces of one object that are the same space are reported, unless a box or a model distinguishes them."""

from __future__ import annotations

import pytest

from checks.models import found
from kit import SCENE

SAME = SCENE.replace("workspace tray_ws", "workspace tray_ws, workspace spare_ws").replace(
    "scene (ns=env)", "comp (ns=env) spare of ws <places.spare_ws> { obj <furniture.tray> }\nscene (ns=env)"
).replace("agn set <arms> }", "ws comp <spare> agn set <arms> }")  # fmt: skip
INSIDE = SAME.replace("{ obj <furniture.tray> }\nscene", "{ obj <furniture.tray> ws <places.tray_ws> }\nscene")
BOX = "ws <places.spare_ws> { box { offset: (0, 0, 0.1) m size: (0.1, 0.1, 0.1) m } }"
OWN = 'obj <furniture.tray> { model own as mjcf { catalog "tray" } }'
MESSAGE = "'spare_ws' and 'tray_ws' are the same space, because 'tray' carries them and has only one"


def instance(entry: str) -> str:
    return f"""//- main.scenex
import "lab.scene"
ns s = 'https://example.org/s/'
scene inst (ns=s) sim {{ scene: <bench_scene> {entry} }}
"""


def messages(scene: str, first: str) -> list[str]:
    return [one.message.partition(":")[0] for one in found(f"{first}//- lab.scene\n{scene}", "same-space")]


@pytest.mark.parametrize(
    ("entry", "expected"), [("", [MESSAGE]), (BOX, []), (OWN, [])], ids=["neither", "box", "model"]
)
def test_of_an_executable_scene_those_without_a_box_or_a_model_are_reported(entry: str, expected: list[str]) -> None:
    assert messages(SAME, instance(entry)) == expected


def test_a_workspace_that_is_inside_of_the_other_one_is_not_reported() -> None:
    assert messages(INSIDE, instance("")) == []
