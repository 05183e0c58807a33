"""Names of executable scenes and executions are found across all kinds of files."""

import sys
from pathlib import Path, PureWindowsPath

import pytest

from kit import FOLDER, MODEL, Fixture, assert_diagnostics, corpus, fixture
from robbdd_tools.base import uris
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import all_diagnostics, fast_diagnostics
from robbdd_tools.names import imports
from robbdd_tools.names.definition import Definition
from robbdd_tools.names.project import Project

ARM = """ktree arm_tree {
    body base { frame origin { } frame mount { } }
    body link { frame origin { } }
    joints { fixed bolted { parent: <base.mount> child: <link.origin> } }
}
"""
CELL = """import "arm.ktree"
import "lab.scene"
ns x = 'https://example.org/x/'
ktree inst (ns=x) left of <arm_tree>
ktree inst (ns=x) right of <arm_tree>
ktree (ns=x) tools { body cup { frame tip { } } joints { } }
ktree (ns=x) cell {
    tree <left>
    tree <tools>
    joints {
        fixed held { parent: <left.link.origin> child: <tools.cup.tip> }
        serial { root: <left.base.origin> tip: <cell.tools.cup.tip> }
    }
}
scene inst (ns=x) bench_mjc {
    scene: <bench_scene>
    kgraph (ns=x) g {
        tree <cell>
        body world { frame root { pose in_cell { wrt: <right.base.mount> xyz: (0, 0, 0) m orientation: quat {
            xyzw: (0, 0, 0, 1)
        } } } }
        joints { fixed placed { parent: <world.root> child: <right.base.origin> } }
    }
    agn <arms.panda> {
        model panda_m as mjcf { catalog "franka-panda" map tree <left> to "panda" map body <g.world> to "world" }
        camera wrist { frame: <left.link.origin> type: rgb resolution: (2, 2) fov: 1 rad update-rate: 30 Hz }
    }
}
"""
RUN = """import "main.bdd"
import "cell.scenex"
ns r = 'https://example.org/r/'
bhv impl (ns=r) builtin { catalog "pick-place" }
obs provider (ns=r) truth { simulation ground truth update-rate: 100 Hz }
observation (ns=r) part { provider: <truth> observes var <fetch.part> }
obs policy (ns=r) there for <fetch.in-tray> {
    observations: { <part> }
    evaluator: linear distance { less-than: 5 cm }
}
obs policy (ns=r) kept for <bench-to-tray.kept> { trinary topic: "/kept" }
Scenario Exec (ns=r) run {
    variant: <fetching.bench-to-tray>
    scene inst: <bench_mjc>
    bhv: <builtin>
    policies: { <there>, <kept> }
}
"""
VARIANT = MODEL.replace(
    "variation:", "Then: kept: holds(<fetch.part> is held by <fetch.robot>, after <end>)\nvariation:"
)


def project(**changed: str) -> Fixture:
    """All files, some of them changed, starting with the first changed one (else with the execution)."""
    files = {"run.bddx": RUN, "cell.scenex": CELL, "arm.ktree": ARM, "main.bdd": VARIANT}
    named = {name.replace("_", "."): text for name, text in changed.items()}
    order = [*named, *(name for name in files if name not in named)]
    return fixture("".join(f"//- {name}\n{(files | named)[name]}" for name in order))


def check(case: Fixture) -> None:
    analyses = [case.snapshot.file(uri) for uri in case.project.texts()]
    assert_diagnostics([entry for analysis in analyses if analysis for entry in analysis.diagnostics], case)


def findings(case: Fixture) -> list[Diagnostic]:
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    return list(analysis.diagnostics)


def target(case: Fixture, path: str) -> Definition:
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    return next(
        definition for placed in analysis.declarations for ref, definition in placed.targets.items() if ref.path == path
    )


def test_a_sound_project_of_all_kinds_has_no_finding() -> None:
    check(project())


def test_what_belongs_to_an_instance_is_declared_in_its_template() -> None:
    found = target(project(cell_scenex=CELL), "left.link.origin")
    assert (found.uri, found.symbol.path) == (FOLDER + "arm.ktree", "arm_tree.link.origin")


def test_a_tree_in_a_tree_leads_to_its_parts() -> None:
    found = target(project(cell_scenex=CELL), "cell.tools.cup.tip")
    assert found.symbol.path == "tools.cup.tip"


def test_a_clause_of_a_variant_is_found_without_its_story() -> None:
    assert target(project(), "bench-to-tray.kept").symbol.path == "fetching.bench-to-tray.kept"


def test_an_unknown_part_of_an_instance_is_reported_with_the_nearest_one() -> None:
    case = project(cell_scenex=CELL.replace("<left.link.origin> type", "<left.lnk.origin> type"))
    (found,) = findings(case)
    assert found.message == "there is no frame 'left.lnk.origin'; did you mean 'left.link.origin'?"


def test_trees_that_contain_each_other_are_no_trap() -> None:
    text = (
        "//- a.scenex\nns x = 'https://example.org/x/'\nktree inst (ns=x) a of <b>\nktree inst (ns=x) b of <a>\n"
        "ktree (ns=x) c { tree <c> joints { fixed f { parent: <a.x.y> child: <c.c.c.x.y> } } }\n"
    )
    assert [entry.code for entry in findings(fixture(text))] == ["wrong-kind"] * 2 + ["unknown-name"] * 2


def test_an_edit_of_the_template_reaches_the_users_of_its_instances() -> None:
    case = project(cell_scenex=CELL)
    assert findings(case) == []
    case.project.open(
        FOLDER + "arm.ktree", 2, ARM.replace("frame mount", "frame flange").replace("<base.mount>", "<base.flange>")
    )
    assert [entry.code for entry in findings(case)] == ["unknown-name"]
    case.project.open(FOLDER + "arm.ktree", 3, ARM)
    assert findings(case) == []


def test_an_instance_of_another_template_has_other_parts() -> None:
    case = project(cell_scenex=CELL)
    assert findings(case) == []
    other = "ktree other_tree { body base { frame origin { } frame mount { } } joints { } }\n"
    case.project.open(FOLDER + "cell.scenex", 2, CELL.replace("left of <arm_tree>", "left of <other_tree>") + other)
    assert {entry.message.split("'")[1] for entry in findings(case)} == {"left.link.origin"}
    case.project.open(FOLDER + "cell.scenex", 3, CELL)
    assert findings(case) == []


def test_a_broken_instance_keeps_its_parts() -> None:
    case = project(cell_scenex=CELL.replace("ktree inst (ns=x) left of <arm_tree>", "ktree inst left of <arm_tree>"))
    assert [entry.code for entry in findings(case)] == ["syntax"]


def test_completion_offers_the_parts_of_instances() -> None:
    case = project(cell_scenex=CELL.replace("root: <left.base.origin>", "root: <$0>"))
    labels = [entry.label for entry in complete(case.snapshot, case.uri, case.cursor)]
    assert {"left.base.origin", "right.link.origin", "tools.cup.tip"} <= set(labels)


def test_iris_of_executable_things_follow_their_namespaces() -> None:
    case = project(cell_scenex=CELL)
    analysis = case.snapshot.file(case.uri)
    assert analysis is not None
    iris = {path: definition.iri for path, definition in analysis.definitions.items()}
    assert iris["left"] == "https://example.org/x/left"
    assert iris["bench_mjc.g"] == "https://example.org/x/g"
    assert iris["tools.cup"] is None


@pytest.mark.parametrize(
    ("name", "path", "words"),
    [
        ("a.scene", "main.bdd", "only '.scene', '.ttl', '.json' and '.jsonld' files"),
        ("a.bdd", "cell.scenex", "only '.bdd', '.scene', '.ttl', '.json' and '.jsonld' files"),
        ("a.ktree", "lab.scene", "only '.ktree' files"),
        ("a.scenex", "main.bdd", "only '.ktree', '.scene', '.scenex', '.ttl', '.json' and '.jsonld' files"),
        ("a.bddx", "lab.scene", "only '.bdd' and '.scenex' files"),
    ],
)
def test_each_kind_imports_what_it_can_use(name: str, path: str, words: str) -> None:
    (found,) = [entry for entry in findings(fixture(f'//- {name}\nimport "{path}"\n')) if entry.code == "import"]
    assert found.severity is Severity.ERROR
    assert words in found.message


def test_a_package_that_is_not_installed_is_a_warning_on_the_import_and_nothing_else() -> None:
    text = (
        "import \"no_such_package:robots/arm.ktree\"\nns x = 'https://example.org/x/'\nktree inst (ns=x) a of <arm>\n"
    )
    case = fixture(f'//- a.scenex\n{text}//- b.scenex\nimport "a.scenex"\n')
    (found,) = findings(case)
    assert (found.severity, found.code) == (Severity.WARNING, "import")
    assert "'no_such_package' is not installed" in found.message
    importer = case.snapshot.file(FOLDER + "b.scenex")
    assert importer is not None
    assert importer.diagnostics == ()


def test_a_package_that_is_installed_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "arm_package" / "robots").mkdir(parents=True)
    (tmp_path / "arm_package" / "__init__.py").write_text("raise RuntimeError('imported while editing')")
    (tmp_path / "arm_package" / "robots" / "arm.ktree").write_text(ARM)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    assert imports.missing_package(imports.import_uri("file:///a.scenex", "arm_package:robots/arm.ktree")) is None
    text = CELL.replace('"arm.ktree"', '"arm_package:robots/arm.ktree"')
    check(fixture(f"//- cell.scenex\n{text}"))


def test_an_address_or_a_drive_is_no_package() -> None:
    assert imports.import_uri("file:///a/b.bdd", "lab.scene") == "file:///a/lab.scene"
    for path in ("https://example.org/a.scene", "C:/models/a.scene"):
        assert imports.missing_package(imports.import_uri("file:///a/b.bdd", path)) is None


def test_a_path_with_backslashes_is_reported_with_the_one_that_all_systems_read() -> None:
    found = findings(fixture("//- a.bdd\n" + r'import "cells\lab.scene"' + "\n"))
    assert [entry.message for entry in found] == [
        r"only Windows reads 'cells\lab.scene': write 'cells/lab.scene', which all systems read"
    ]


def test_windows_reads_a_path_with_a_drive(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(uris, "HERE", PureWindowsPath)
    assert imports.import_uri("file:///c%3A/a/b.bdd", "D:/lab/one.scene") == "file:///d%3A/lab/one.scene"


def test_names_behind_an_unread_file_of_their_kind_are_not_reported() -> None:
    found = findings(fixture("//- a.scenex\n" + CELL.replace("arm.ktree", "gone.ktree")))
    assert [entry.code for entry in found] == ["import"]


def test_a_model_file_that_is_not_here_is_a_warning(tmp_path: Path) -> None:
    (tmp_path / "here.xml").write_text("<mujoco/>")
    models = "".join(
        f"model {name} as mjcf {{ sys path = '{path}' }} "
        for name, path in (("a", "here.xml"), ("b", "gone.xml"), ("c", "~/gone.xml"), ("d", "~nobody-at-all/x.xml"))
    )
    text = f"ns x = 'https://example.org/x/'\nscene inst (ns=x) i {{ scene: <s> {models}}}"
    loaded = Project()
    uri = path_to_uri(tmp_path / "a.scenex")
    loaded.open(uri, 1, text)
    found = [entry for entry in fast_diagnostics(loaded.snapshot(), uri) if entry.code == "model-file"]
    assert [text[entry.span.start : entry.span.end] for entry in found] == [
        "'gone.xml'",
        "'~/gone.xml'",
        "'~nobody-at-all/x.xml'",
    ]
    assert {entry.severity for entry in found} == {Severity.WARNING}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"cell_scenex": CELL.replace("franka-panda", "franka-pandas")}, "did you mean 'franka-panda'?"),
        ({"run_bddx": RUN.replace("pick-place", "juggle")}, "no behaviour 'juggle': it has pick"),
    ],
)
def test_the_catalog_must_have_what_it_is_asked_for(changed: dict[str, str], words: str) -> None:
    case = project(**changed)
    (found,) = [entry for entry in fast_diagnostics(case.snapshot, case.uri) if entry.code == "catalog-entry"]
    assert found.severity is Severity.ERROR
    assert words in found.message


def test_foreign_models_of_every_kind_have_no_error() -> None:
    loaded = Project()
    uris = [path_to_uri(path) for path in corpus(".bdd", ".scene", ".scenex", ".ktree", ".bddx")]
    assert uris
    for uri in uris:
        loaded.load(uri)
    snapshot = loaded.snapshot()
    for uri in uris:
        errors = [entry for entry in all_diagnostics(snapshot, uri) if entry.severity is Severity.ERROR]
        assert errors == []
