"""A fixed object from a file without a pose is placed by a quick fix, and can be moved from there."""

from __future__ import annotations

from pathlib import Path

import pytest

from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.scene_findings import SceneChecker

SHAPE = '<geom type="box" size="0.1 0.1 0.02" pos="0 0 0.02"/>'
JIG = f'<mujoco><worldbody><body name="jig">{SHAPE}</body></worldbody></mujoco>'
ROOM = "        body room { frame origin { } }\n"
SCENE = """ns env = 'https://x.example/'
obj set (ns=env) things { object jig, object table }
scene (ns=env) cell { obj set <things> }
"""
HEAD = """import "x.scene"
ns sim = 'https://x.example/sim/'
scene inst (ns=sim) cell_sim {
    scene: <cell>
"""
GRAPH = """    kgraph (ns=sim) places {
        body hall { frame corner { } }
    }
"""
MODEL = "    obj <things.jig> { model jig_model as mjcf { sys path = 'jig.xml' } }\n"
BODY = """        body jig {
            frame base {
                pose jig_in_room {
                    wrt: <FRAME>
                    xyz: (0.5, 0, 0.1) m
                    orientation: quat { xyzw: (0, 0, 0, 1) }
                }
            }
        }
    }
"""


@pytest.fixture
def scenex(tmp_path: Path) -> Path:
    (tmp_path / "jig.xml").write_text(JIG, encoding="utf-8")
    (tmp_path / "x.scene").write_text(SCENE, encoding="utf-8")
    return tmp_path / "x.scenex"


def findings(path: Path, text: str) -> list[Diagnostic]:
    path.write_text(text, encoding="utf-8")
    project = Project()
    project.load(path_to_uri(path))
    return SceneChecker().findings(project.snapshot(), path_to_uri(path))


def fixed(path: Path, text: str) -> str:
    (finding,) = findings(path, text)
    (fix,) = finding.fixes
    assert fix.title == "Place 'jig' on the catalog's table, to be moved from there"
    for edit in sorted(fix.edits, key=lambda one: one.span.start, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


@pytest.mark.parametrize(
    ("graph", "placed", "name"),
    [
        (
            "",
            "    kgraph (ns=sim) poses {\n" + ROOM + BODY.replace("FRAME", "room.origin"),
            "poses",
        ),
        (GRAPH, GRAPH.removesuffix("    }\n") + BODY.replace("FRAME", "hall.corner"), "places"),
    ],
)
def test_an_object_is_placed_on_the_table(scenex: Path, graph: str, placed: str, name: str) -> None:
    after = fixed(scenex, f"{HEAD}{graph}{MODEL}}}\n")
    mapped = MODEL.replace("'jig.xml'", f"'jig.xml' map body <{name}.jig>")
    assert after == f"{HEAD}{placed}{mapped}}}\n"
    assert findings(scenex, after) == []


@pytest.mark.parametrize(
    "graph",
    [
        GRAPH.replace("hall", "jig"),
        "    kgraph (ns=sim) places { }\n",
    ],
)
def test_no_fix_is_offered_where_the_name_is_taken_or_no_frame_is_in_the_graph(scenex: Path, graph: str) -> None:
    (finding,) = findings(scenex, f"{HEAD}{graph}{MODEL}}}\n")
    assert finding.code == "pose"
    assert finding.fixes == ()
