"""Scene instances for tests: links between frames, models from files and from the catalog."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from robbdd_tools.catalog.executable import Body, Law, Link, ModelSource, Origin, Realisation, SceneInstance

ROOT = "x:g.world.root"
BLOCK = """<mujoco><worldbody>
  <body name="plate"><geom type="box" size=".1 .1 .01"/></body>
  <body name="block"><freejoint/><geom type="box" size=".012 .02 .03" mass="0.05" friction="0.7"/></body>
</worldbody></mujoco>"""
BRACKET = """<mujoco><worldbody><body name="bracket"><freejoint/>
<geom type="box" size=".04 .03 .004" pos="0 0 .004" mass="0.04"/>
<geom type="box" size=".004 .03 .025" pos=".036 0 .033" mass="0.05"/></body></worldbody></mujoco>"""
TRAY = """<mujoco><worldbody><body name="tray"><geom type="box" size=".1 .15 .01"/>
<site name="workspace" type="box" size=".09 .14 .05" pos="0 0 .06"/></body></worldbody></mujoco>"""


def link(frame: str, position: tuple[float, ...], base: str = ROOT, turn: tuple[float, ...] = (1, 0, 0, 0)) -> Link:
    return Link(frame, base, "pose", position, turn, origin=Origin("/w/cell.scenex", 9, 5))


def instance(*links: Link, laws: tuple[Law, ...] = (), elements: tuple[Realisation, ...] = ()) -> SceneInstance:
    frames = dict.fromkeys(end for one in links for end in (one.base, one.frame))
    bodies = tuple(Body(frame.rpartition(".")[0], (frame,), Origin("/w/cell.scenex", 4, 9)) for frame in frames)
    return SceneInstance("x:cell", (), elements, bodies, links, laws, ROOT)


def catalog(element: str, name: str, body: str = "") -> Realisation:
    bodies = ((body, "body"),) if body else ()
    return Realisation(element, (ModelSource(f"x:{name}", "mjcf", "catalog", name, bodies=bodies),))


def file(folder: Path, element: str, text: str, body: tuple[str, str] | None = None) -> Realisation:
    (folder / "thing.xml").write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 7, 11)
    bodies = () if body is None else (body,)
    return Realisation(element, (ModelSource("x:thing", "mjcf", "file", "thing.xml", bodies=bodies, origin=origin),))


SAMPLED = replace(link("x:g.cube.mid", ()), position_law="x:spread", scale=0.01)
