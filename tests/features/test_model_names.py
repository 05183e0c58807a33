"""Names of bodies, joints, sites, geoms and actuators in a ``.scenex``: checked, completed, described, opened."""

from pathlib import Path

import pytest

from base.test_model_parts import CART, gantry
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.completion import complete
from robbdd_tools.features.describe_entry import describe_entry
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.outside_files import outside_uris
from robbdd_tools.features.outside_names import outside_name_at, outside_references
from robbdd_tools.names.project import Project, Snapshot

HEAD = "ns x = 'http://x/'\nscene inst (ns=x) s { scene: <s>\nkgraph (ns=x) poses { body foot { frame middle { } } }\n"
ARM = """agn <arms.a> { model arm as mjcf {
    sys path = 'gantry.xml'
    map body <poses.foot> to "base"
    tool: "tip"
    gripper { actuator: "close" pads: "pad_ä", "hand" }
} } }
"""
HULL = '<mesh filename="package://cart_description/meshes/hull.stl"/>'
LINKS = ARM.replace("as mjcf", "as urdf").replace("gantry.xml", "cart.urdf").replace('"base"', '"chassis"')


def opened(folder: Path, text: str) -> tuple[Snapshot, str, int]:
    if not (folder / "gantry.xml").exists():
        gantry(folder)
        (folder / "cart.urdf").write_text(CART.replace(HULL, '<box size="1 1 1"/>'), encoding="utf-8")
    text = HEAD + text
    project, uri = Project(), path_to_uri(folder / "cell.scenex")
    project.open(uri, 1, text.replace("$0", ""))
    return project.snapshot(), uri, text.find("$0")


def edited(old: str, new: str, text: str = ARM) -> str:
    assert text.count(old) == 1
    return text.replace(old, new)


def findings(folder: Path, text: str) -> list[Diagnostic]:
    snapshot, uri, _ = opened(folder, text)
    return [one for one in fast_diagnostics(snapshot, uri) if one.code in ("model-name", "model-file")]


def test_names_that_exist_are_not_reported(tmp_path: Path) -> None:
    assert findings(tmp_path, ARM) == []


@pytest.mark.parametrize(
    ("old", "new", "message", "fixes"),
    [
        ('"base"', '"bse"', "no body 'bse'; did you mean 'base'?", ["base"]),
        ('"tip"', "'tpi'", "no site or body 'tpi'; did you mean 'tip'?", ["tip"]),
        ('"close"', '"closed"', "no actuator or joint 'closed'; did you mean 'close'?", ["close"]),
        ('"hand"', '"shel"', "no geom or body 'shel'; did you mean 'shell'?", ["shell"]),
        (
            '"base"',
            '"xyz"',
            "no body 'xyz'; it has the bodies 'hand', 'base', 'elbow'",
            ["hand", "base", "elbow"],
        ),
    ],
)
def test_a_wrong_name_is_reported_with_the_nearest(
    tmp_path: Path, old: str, new: str, message: str, fixes: list[str]
) -> None:
    text = edited(old, new)
    (found,) = findings(tmp_path, text)
    assert (found.code, found.message) == ("model-name", f"the model's file has {message}")
    assert (HEAD + text)[found.span.start : found.span.end] == new
    quote = new[0]
    assert [fix.edits[0].text for fix in found.fixes] == [f"{quote}{name}{quote}" for name in fixes]


def test_a_body_that_is_mapped_without_a_name_has_its_own_name_in_the_file(tmp_path: Path) -> None:
    short = edited(' to "base"', "")
    assert findings(tmp_path, short.replace("<poses.foot>", "<poses.base>")) == []
    (found,) = findings(tmp_path, short)
    assert found.message == "the model's file has no body 'foot'; it has the bodies 'hand', 'base', 'elbow'"
    text = HEAD + short
    assert text[found.span.start : found.span.end] == "poses.foot"
    (edit,) = found.fixes[1].edits
    assert (found.fixes[1].title, edit.text) == ("Add 'to \"base\"'", ' to "base"')
    assert text[: edit.span.start].endswith("map body <poses.foot>")


MOUNTED = edited('gripper { actuator: "close"', 'gripper { sys path = \'hand.xml\' on: "hand" actuator: "close"')
HAND = '<mujoco><worldbody><body name="palm"><site name="tip"/><geom name="pad_ä"/></body></worldbody></mujoco>'


def test_names_of_a_mounted_gripper_are_those_in_its_file(tmp_path: Path) -> None:
    (tmp_path / "hand.xml").write_text(HAND, encoding="utf-8")
    text = MOUNTED.replace('on: "hand"', 'on: "palm"').replace('"hand" }', '"hand2" }')
    assert [one.message.partition(";")[0] for one in findings(tmp_path, text)] == [
        "the model's file has no site or body 'palm'",
        "the model's file has no actuator or joint 'close'",
        "the model's file has no geom or body 'hand2'",
    ]


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('on: "hand"', 'on: "$0', ["tip", "hand", "base", "elbow"]),
        ('"tip"', '"$0"', ["tip", "palm"]),
        ('"pad_ä", "hand"', '"$0"', ["pad_ä", "palm"]),
    ],
)
def test_names_of_a_mounted_gripper_are_completed(tmp_path: Path, old: str, new: str, wanted: list[str]) -> None:
    (tmp_path / "hand.xml").write_text(HAND, encoding="utf-8")
    assert [one.label for one in complete(*opened(tmp_path, edited(old, new, MOUNTED)))] == wanted


@pytest.mark.parametrize(
    ("pose", "message"),
    [
        ("offset: (0, 5) mm", "an offset needs 3 numbers, not 2"),
        ("orientation: quat { xyzw: (0, 0, 1) }", "this is not a rotation: a quaternion has 4 numbers"),
        (
            "orientation: quat { sample <spin> }",
            "the orientation of a gripper cannot be drawn at random: write a rotation",
        ),
    ],
)
def test_an_impossible_pose_of_a_mounted_gripper_is_reported(tmp_path: Path, pose: str, message: str) -> None:
    snapshot, uri, _ = opened(tmp_path, edited('on: "hand"', f'on: "hand" {pose}', MOUNTED))
    (found,) = (one for one in fast_diagnostics(snapshot, uri) if one.code == "pose")
    assert found.message.startswith(message)


def test_the_file_of_a_mounted_gripper_is_opened_and_described(tmp_path: Path) -> None:
    (tmp_path / "hand.xml").write_text(HAND, encoding="utf-8")
    snapshot, uri, _ = opened(tmp_path, MOUNTED)
    place = (HEAD + MOUNTED).index("hand.xml")
    named = outside_name_at(snapshot, uri, place)
    assert named is not None
    definition = named.definition()
    assert definition is not None
    assert definition.uri == path_to_uri(tmp_path / "hand.xml")
    assert path_to_uri(tmp_path / "hand.xml") in outside_uris(snapshot, uri)


def test_the_missing_file_of_a_gripper_is_reported_once_at_its_path(tmp_path: Path) -> None:
    (found,) = findings(tmp_path, MOUNTED)
    assert found.message.startswith("the model file 'hand.xml' is not on this machine")
    text = HEAD + MOUNTED
    assert text[found.span.start : found.span.end] == "'hand.xml'"


def test_names_in_a_urdf_file_are_links_and_joints(tmp_path: Path) -> None:
    found = findings(tmp_path, LINKS)
    assert [one.message.partition(";")[0] for one in found] == [
        "the model's file has no site or body 'tip'",
        "the model's file has no actuator or joint 'close'",
        "the model's file has no geom or body 'pad_ä'",
        "the model's file has no geom or body 'hand'",
    ]


def test_the_wrong_format_is_reported(tmp_path: Path) -> None:
    (found,) = findings(tmp_path, edited("as mjcf", "as urdf"))
    assert (found.code, found.message) == ("model-file", "the model file is MJCF, not URDF: write 'as mjcf'")
    assert [fix.edits[0].text for fix in found.fixes] == ["mjcf"]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("sys path = 'broken.xml'", "the model file cannot be used: line 1 of 'broken.xml' is not XML: mismatched tag"),
        ("sys path = 'gone.xml'", "the model file 'gone.xml' is not on this machine"),
        ("sys path = '~nobody-is-called-this/a.xml'", "the model file '~nobody-is-called-this/a.xml' is not on this"),
        ("ros pkg = 'gone', path = 'a.urdf'", "the ROS package 'gone' cannot be found: AMENT_PREFIX_PATH is not set"),
    ],
)
def test_an_unusable_file_is_reported_at_its_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, source: str, message: str
) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    (tmp_path / "broken.xml").write_text("<mujoco><a></mujoco>", encoding="utf-8")
    (found,) = findings(tmp_path, edited("sys path = 'gantry.xml'", source))
    assert (found.code, found.message[: len(message)]) == ("model-file", message)


def test_files_of_ros_packages_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    share = tmp_path / "ros" / "share" / "carts"
    (share / "urdf").mkdir(parents=True)
    (share / "package.xml").write_text("<package/>", encoding="utf-8")
    (share / "urdf" / "cart.urdf").write_text(CART.replace(HULL, '<box size="1 1 1"/>'), encoding="utf-8")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ros"))
    source = "ros pkg = 'carts', path = 'urdf/cart.urdf'"
    text = edited("sys path = 'cart.urdf'", source, LINKS)
    assert {one.code for one in findings(tmp_path, text)} == {"model-name"}
    for typed, labels in (
        ("ros pkg = '$0", ["carts"]),
        ("ros pkg = 'carts', path = 'u$0", ["package.xml", "urdf/"]),
        ("ros pkg = 'carts', path = 'urdf/$0", ["cart.urdf"]),
        (f'{source}\nmap body <poses.foot> to "$0', ["chassis", "mast"]),
    ):
        cut = edited("sys path = 'cart.urdf'", typed, LINKS)
        assert [one.label for one in complete(*opened(tmp_path, cut))] == labels


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('"base"', '"$0"', ["hand", "base", "elbow"]),
        ('"base"', '"ba$0se"', ["hand", "base", "elbow"]),
        ('"tip"', "'$0", ["tip", "hand", "base", "elbow"]),
        ('"close"', '"$0', ["close", "fly", "run", "bend", "turn"]),
        ('"hand"', '"$0', ["pad_ä", "shell", "hand", "base", "elbow"]),
    ],
)
def test_the_parts_of_the_file_are_offered(tmp_path: Path, old: str, new: str, wanted: list[str]) -> None:
    found = complete(*opened(tmp_path, edited(old, new)))
    assert [one.label for one in found] == wanted


def test_a_completion_has_the_facts_and_replaces_the_name(tmp_path: Path) -> None:
    snapshot, uri, offset = opened(tmp_path, edited('"close"', '"tu$0rned"'))
    found = next(one for one in complete(snapshot, uri, offset) if one.label == "turn")
    text = snapshot.document(uri).text
    assert found.detail == "joint, hinge, axis (0, 1, 0), range -10 to 20 deg"
    assert text[found.whole.start : found.whole.end] == "turned"


@pytest.mark.parametrize(
    ("old", "new", "words", "place"),
    [
        (
            '"base"',
            '"elb$0ow"',
            "**body** `elbow` in the body `base`\n\n- mass 2.5 kg\n- at (0, 0, 0.3) m in a frame in the body 'base'"
            "\n\n`gantry.xml:16`",
            "gantry.xml:16:elbow",
        ),
        (
            '"close"',
            '"tu$0rn"',
            "**joint** `turn` of the body `elbow`\n\n- hinge\n- axis (0, 1, 0)\n- range -10 to 20 deg"
            "\n\n`gantry.xml:18`",
            "gantry.xml:18:turn",
        ),
        (
            '"tip"',
            '"t$0ip"',
            "**site** `tip` of the body `hand`\n\n- at (0, 0, 0.1) m in the body 'hand'\n\n`hand.xml:5`",
            "hand.xml:5:tip",
        ),
        (
            "'gantry.xml'",
            "'gantry$0.xml'",
            "**MJCF model** `gantry`\n\n- 3 bodies: `hand`, `base`, `elbow`\n- 4 joints: `fly`, `run`, `bend`, `turn`\n"
            "- 1 site: `tip`\n- 2 geoms: `pad_ä`, `shell`\n- 1 actuator: `close`",
            "gantry.xml:1:",
        ),
    ],
)
def test_a_name_is_described_and_leads_to_its_element(
    tmp_path: Path, old: str, new: str, words: str, place: str
) -> None:
    found = outside_name_at(*opened(tmp_path, edited(old, new)))
    assert found is not None
    assert found.describe() == words
    where = found.definition()
    assert where is not None
    document = Document(where.uri, 0, where.text)
    line = document.position(where.span.start).line + 1
    name = where.text[where.span.start : where.span.end]
    assert f"{where.uri.rpartition('/')[2]}:{line}:{name}" == place


def test_a_catalog_entry_is_described_and_leads_to_its_python_file(tmp_path: Path) -> None:
    found = outside_name_at(*opened(tmp_path, edited("sys path = 'gantry.xml'", 'catalog "franka$0-panda"')))
    assert found is not None
    assert str(found.describe()).startswith("`franka-panda`\n\n")
    where = found.definition()
    assert where is not None
    assert where.uri.endswith("/catalog/robots/panda.py")


def test_an_offered_model_file_is_described_by_its_parts(tmp_path: Path) -> None:
    snapshot, uri, offset = opened(tmp_path, edited("'gantry.xml'", "'$0'"))
    found = next(one for one in complete(snapshot, uri, offset) if one.label == "cart.urdf")
    assert found.origin is not None
    assert str(describe_entry(snapshot, found.kind, *found.origin)).startswith("**URDF model** `cart`\n\n- 2 bodies: ")


def test_models_without_a_readable_file_have_no_names(tmp_path: Path) -> None:
    for source in ('catalog "franka-panda"', "py { module: own, attr: arm }", "sys path = 'gone.xml'"):
        text = edited("sys path = 'gantry.xml'", source)
        assert [one for one in findings(tmp_path, text) if one.code == "model-name"] == []
        assert outside_name_at(*opened(tmp_path, text.replace('"tip"', '"t$0ip"'))) is None


def test_all_places_in_the_models_that_name_a_part_are_found(tmp_path: Path) -> None:
    other = ARM.replace("<arms.a>", "<arms.b>").replace("model arm", "model other").replace('"tip"', '"base"')
    twice = ARM.rstrip()[:-1] + other
    snapshot, uri, offset = opened(tmp_path, twice.replace('to "base"', 'to "ba$0se"', 1))
    found, place = outside_references(snapshot, uri, offset)
    text = snapshot.document(uri).text
    lines = [text[text.rfind("\n", 0, span.start) + 1 : span.end].strip() for _, span in found]
    assert sorted(lines) == ['map body <poses.foot> to "base"', 'map body <poses.foot> to "base"', 'tool: "base"']
    assert place is not None
    assert place.uri.endswith("gantry.xml")
    assert outside_references(snapshot, uri, 0) == ([], None)
