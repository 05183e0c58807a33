"""What makes every clause of an execution unknown is reported while editing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from checks.models import apply
from kit import MODEL, Fixture, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names.project import Project

BDDX = """import "main.bdd"
import "lab.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) built-in { catalog "pick-place" }
obs provider (ns=x) truth { simulation ground truth update-rate: 100 Hz }
observation (ns=x) part-pose { provider: <truth> observes var <fetch.part> }
observation (ns=x) goal-pose { provider: <truth> observes var <fetch.goal> }
obs policy (ns=x) near for <fetch.in-tray> horizon: 0.5 seconds {
    observations: { <part-pose>, <goal-pose> }
    evaluator: linear distance { between: 1 cm and 0.2 m max time offset: 0.02 s }
}
Scenario Exec (ns=x) run {
    variant: <fetching.bench-to-tray>
    scene inst: <lab_sim>
    bhv: <built-in>
    policies: { <near> }
    repeat: 1
    seed: 1
    timeout: 60 seconds
}
"""
SCENEX = """import "lab.scene"
ns sim = 'https://example.org/sim/'
scene inst (ns=sim) lab_sim { scene: <bench_scene> }
"""


def execution(old: str = "", new: str = "") -> Fixture:
    """An execution in which a piece of text is replaced by another."""
    assert old in BDDX
    return fixture(f"//- run.bddx\n{BDDX.replace(old, new, 1)}//- main.bdd\n{MODEL}//- lab.scenex\n{SCENEX}")


def findings(case: Fixture) -> list[Diagnostic]:
    return fast_diagnostics(case.snapshot, case.uri)


def texts_and_codes(case: Fixture) -> list[tuple[str, str]]:
    """Text and code of each finding."""
    text = case.snapshot.document(case.uri).text
    return [(text[one.span.start : one.span.end], one.code) for one in findings(case)]


def test_a_sound_execution_has_no_finding() -> None:
    assert texts_and_codes(execution()) == []


@pytest.mark.parametrize(
    ("old", "new", "blamed", "message"),
    [
        ("100 Hz", "0 Hz", "0", "an update rate cannot be 0: write a number greater than 0"),
        ("100 Hz", "9 Hz noise: -2 mm", "-2", "noise cannot be -2: write a number of at least 0"),
        ("100 Hz", "9 Hz misses: 101 %", "101", "a share of missed observations cannot be 101: write a number from 0"),
        (
            "100 Hz",
            "9 Hz range: 0 m to 1 m from obj <parts.bolt> field of view: 0 deg",
            "0",
            "a field of view cannot be 0: write a number greater than 0 and up to 360",
        ),
        (
            "100 Hz",
            "9 Hz range: 1 m to 30 cm from obj <parts.bolt>",
            "1 m",
            "the bounds are reversed: the lower one comes first",
        ),
        ("100 Hz", "9 Hz latency: -1.5 s", "-1.5", "a latency cannot be -1.5: write a number of at least 0"),
        ("horizon: 0.5", "horizon: -0.5", "-0.5", "a horizon cannot be -0.5: write a number of at least 0"),
        ("offset: 0.02", "offset: -1", "-1", "a time offset cannot be -1: write a number of at least 0"),
        ("1 cm", "-1 cm", "-1", "a distance cannot be -1: write a number of at least 0"),
        ("1 cm", "300 mm", "300 mm", "the bounds are reversed: the lower one comes first"),
        ("repeat: 1", "repeat: 0", "0", "the number of repetitions cannot be 0: write a whole number of at least 1"),
        ("seed: 1", "seed: -1", "-1", "a seed cannot be -1: write a whole number from 0 to 4294967295"),
        ("seed: 1", "seed: 1.5", "1.5", "a seed cannot be 1.5: write a whole number from 0 to 4294967295"),
        ("seed: 1", "seed: 4294967296", "4294967296", "a seed cannot be 4294967296: write a whole number"),
        ("60 seconds", "0 seconds", "0", "a timeout cannot be 0: write a number greater than 0"),
    ],
)
def test_a_number_that_cannot_be_is_an_error_at_the_number(old: str, new: str, blamed: str, message: str) -> None:
    case = execution(old, new)
    (found,) = findings(case)
    assert texts_and_codes(case) == [(blamed, "number-range")]
    assert found.severity is Severity.ERROR
    assert found.message.startswith(message)


@pytest.mark.parametrize(
    ("old", "new", "fixed"),
    [
        ("seed: 1", "seed: -7", "seed: 7"),
        ("repeat: 1", "repeat: 0", "repeat: 1"),
        ("1 cm", "1 m", "between: 0.2 m and 1 m"),
    ],
)
def test_a_number_with_a_certain_fix_is_fixed(old: str, new: str, fixed: str) -> None:
    case = execution(old, new)
    (found,) = findings(case)
    apply(case, found.fixes[0])
    assert findings(case) == []
    assert fixed in case.project.texts()[case.uri][1]


@pytest.mark.parametrize(
    ("old", "new", "blamed"),
    [
        ('catalog "pick-place"', 'bhv action: "/a"', 'bhv action: "/a"'),
        ("simulation ground truth", "ros simulation entity state", "ros simulation entity state update-rate: 100 Hz"),
        ("simulation ground truth update-rate: 100 Hz", 'ros topic: "/p" type: "m"', 'ros topic: "/p" type: "m"'),
    ],
)
def test_what_needs_ros_is_an_information_with_its_counterpart(old: str, new: str, blamed: str) -> None:
    case = execution(old, new)
    (found,) = findings(case)
    assert (texts_and_codes(case), found.severity) == ([(blamed, "not-simulated")], Severity.INFORMATION)
    apply(case, found.fixes[0])
    assert findings(case) == []


def test_a_trinary_topic_has_no_counterpart() -> None:
    rule = BDDX[BDDX.index("    observations") : BDDX.index("}\nScenario")]
    case = execution(rule, '    trinary topic: "/seen"\n')
    (found,) = findings(case)
    assert (texts_and_codes(case), found.fixes) == ([('trinary topic: "/seen"', "not-simulated")], ())


def test_an_implementation_that_does_not_execute_the_behaviour_is_reported_where_it_is_used() -> None:
    case = execution('"pick-place"', '"pick"')
    (found,) = findings(case)
    assert texts_and_codes(case) == [("built-in", "execution-fit")]
    assert found.message == "'pick' of the catalog does not execute 'pick-place', so that all clauses stay unknown"
    apply(case, found.fixes[0])
    assert case.project.texts()[case.uri][1] == BDDX


def test_a_policy_for_a_duration_is_reported_where_it_names_the_clause() -> None:
    in_time = re.sub(
        r"in-tray: holds\(.*\)", "in-tray: holds(it takes less than 5 s, from <place-start> until <place-end>)", MODEL
    )
    assert in_time != MODEL
    case = fixture(f"//- run.bddx\n{BDDX}//- main.bdd\n{in_time}//- lab.scenex\n{SCENEX}")
    assert ("fetch.in-tray", "execution-fit") in texts_and_codes(case)


@pytest.mark.parametrize(
    ("old", "new", "count"),
    [
        ("<part-pose>, <goal-pose>", "<part-pose>", 1),
        ("var <fetch.part>", "var <fetch.part> observes var <fetch.robot>", 3),
    ],
)
def test_a_distance_of_fewer_or_more_than_two_elements_is_reported(old: str, new: str, count: int) -> None:
    (found,) = findings(execution(old, new))
    assert found.code == "execution-fit"
    assert found.message == f"a distance is between two elements, but {count} are observed"


def checked(path: Path) -> list[Diagnostic]:
    uri, project = path_to_uri(path), Project()
    project.load(uri)
    return [one for one in fast_diagnostics(project.snapshot(), uri) if one.code == "python-source"]


def coded(folder: Path, source: str, module: str = "mine", attribute: str = "Pick") -> Path:
    (folder / "mine.py").write_text(source, encoding="utf-8")
    model = folder / "run.bddx"
    declaration = f"bhv impl (ns=x) own {{ py {{ module: {module}, attr: {attribute} }} }}"
    model.write_text(f"ns x = 'https://example.org/x/'\n{declaration}\n", encoding="utf-8")
    return model


@pytest.mark.parametrize(
    "source",
    [
        "class Pick: ...",
        "def Pick(): ...",
        "from os import path as Pick",
        "if True:\n    Pick = 1",
        "try:\n    import Pick\nexcept ImportError:\n    Pick = None",
        "first, (Pick, *last) = range(3)",
        "Pick: int = 3",
        "from os import *",
        "def __getattr__(name): ...",
        "globals()['Pick'] = 3",
    ],
)
def test_a_name_that_a_module_binds_is_no_finding(tmp_path: Path, source: str) -> None:
    assert checked(coded(tmp_path, source)) == []


@pytest.mark.parametrize(
    "source", ["class Other: ...", "class Other:\n    Pick = 1", "def f():\n    Pick = 1", "x = Pick"]
)
def test_a_name_that_a_module_does_not_bind_is_reported(tmp_path: Path, source: str) -> None:
    (found,) = checked(coded(tmp_path, source))
    assert found.message.startswith("the module 'mine' has no 'Pick'")
    assert found.severity is Severity.WARNING


def test_a_misspelt_name_is_fixed(tmp_path: Path) -> None:
    (attribute,) = checked(coded(tmp_path, "class Picker: ..."))
    assert [fix.title for fix in attribute.fixes] == ["Change to 'Picker'"]
    (module,) = checked(coded(tmp_path, "class Pick: ...", module="mines"))
    assert [fix.title for fix in module.fixes] == ["Change to 'mine'"]


def test_modules_are_read_and_never_imported(tmp_path: Path) -> None:
    planted = tmp_path / "planted"
    text = f"open({str(planted)!r}, 'w')\nclass Pick: ..."
    (tmp_path / "package").mkdir()
    (tmp_path / "package" / "__init__.py").write_text(text, encoding="utf-8")
    (tmp_path / "package" / "inner.py").write_text(text, encoding="utf-8")
    assert checked(coded(tmp_path, text)) == []
    assert checked(coded(tmp_path, text, module="package.inner")) == []
    assert [one.message for one in checked(coded(tmp_path, text, module="package.other"))] == [
        "there is no module 'package.other': put package/other.py next to this file"
    ]
    assert not planted.exists()


def test_a_module_that_is_not_python_is_reported_with_its_line(tmp_path: Path) -> None:
    (found,) = checked(coded(tmp_path, "class Pick:\n    def ("))
    assert "mine.py, line 2: " in found.message


def test_a_module_that_is_changed_is_read_again(tmp_path: Path) -> None:
    model = coded(tmp_path, "class Other: ...")
    assert len(checked(model)) == 1
    (tmp_path / "mine.py").write_text("class Pick: ...\n# longer", encoding="utf-8")
    assert checked(model) == []


@pytest.mark.parametrize(
    ("module", "attribute", "source", "shown"),
    [
        ("mime", "Pick", "class Pick: ...", ("mime", "there is no module 'mime'; did you mean 'mine'?", "mine")),
        ("mine", "Pck", "class Pick: ...", ("Pck", "the module 'mine' has no 'Pck'; did you mean 'Pick'?", "Pick")),
    ],
)
def test_a_name_in_python_is_corrected(
    module: str, attribute: str, source: str, shown: tuple[str, str, str], tmp_path: Path
) -> None:
    model = coded(tmp_path, source, module, attribute)
    (found,) = checked(model)
    text = model.read_text(encoding="utf-8")
    assert (text[found.span.start : found.span.end], found.message) == shown[:2]
    (fix,) = found.fixes
    (edit,) = fix.edits
    assert (fix.title, edit.uri, edit.span) == (f"Change to '{shown[2]}'", found.uri, found.span)
    model.write_text(text[: edit.span.start] + edit.text + text[edit.span.end :], encoding="utf-8")
    assert checked(model) == []


def test_no_private_name_is_offered(tmp_path: Path) -> None:
    (found,) = checked(coded(tmp_path, "class _Pick: ..."))
    assert (found.message, found.fixes) == ("the module 'mine' has no 'Pick'", ())
