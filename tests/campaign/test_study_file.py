"""``.study`` files: what they say, and the errors in them at their places."""

from __future__ import annotations

from pathlib import Path

import pytest

from campaign.study_agents import write_study
from kit import EXAMPLES
from robbdd_tools.campaign.study_batches import batches
from robbdd_tools.campaign.study_file import Study, load_study
from robbdd_tools.cli import main
from robbdd_tools.workbench.named_files import NotAModel

COVERED = "a study covers levels, pairs, clauses, events, predicates, each once, such as 'pairs 90 %'"
HEAD = 'import "m.bdd"\nStudy s {\n'


def errors(folder: Path, text: str) -> list[str]:
    study = load_study(write_study(folder, text))
    assert all(one.code in ("syntax", "study") for one in study.findings)
    return [f"{one.place.line}:{one.place.column} {one.message}" for one in study.findings]


def test_a_study_repeats_all_scenarios_in_equal_batches(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path))
    assert (study.findings, study.name, study.repeat, study.batch) == ((), "fetching", 10, 8)
    found = batches(study)
    assert [(one.number, one.first, one.last, one.size) for one in found[:2]] == [(1, 1, 2, 8), (2, 3, 4, 8)]
    assert (found[-1].first, found[-1].last, found[-1].size, len(found)) == (9, 10, 8, 5)


def test_a_study_selects_scenarios_as_a_run_does(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path, f'{HEAD} scenarios: {{ <bench-to-tray> }} where: "part=bolt" first: 1 }}'))
    assert [one.size for one in batches(study)] == [1]
    (spec,) = study.cells[0].plan.specs()
    assert next(iter(spec.values.values())) == "env:bolt"


def test_the_seed_and_the_repetition_determine_the_seeds_of_executions(tmp_path: Path) -> None:
    def seeds(text: str) -> list[int]:
        return [one.seed for one in load_study(write_study(tmp_path, text)).cells[0].plan.specs(repeat=2)]

    first = seeds(f"{HEAD} seed: 3 }}")
    assert len(set(first)) == 8
    assert first == seeds(f"{HEAD} seed: 3 batch: 1 }}")
    assert not set(first) & set(seeds(f"{HEAD} seed: 4 }}"))


def test_a_repetition_is_a_block_of_executions_with_the_same_seed(tmp_path: Path) -> None:
    free = load_study(write_study(tmp_path, f"{HEAD} seed: 3 }}"))
    blocked = load_study(write_study(tmp_path, f"{HEAD} seed: 3 block: repetition }}"))
    seeds = [(one.repetition, one.seed) for one in blocked.cells[0].plan.specs(repeat=3)]
    assert len(seeds) == 12
    assert len(set(seeds)) == 3
    assert len({seed for _, seed in seeds}) == 3
    prepared = blocked.cells[0].plan.prepare(tmp_path / "prepared", repeat=3).scenarios
    assert {(one.repetition, one.seed) for one in prepared} == set(seeds)
    assert blocked.digest != free.digest
    other = load_study(write_study(tmp_path, f"{HEAD} seed: 4 block: repetition }}"))
    assert {one.seed for one in other.cells[0].plan.specs(repeat=3)}.isdisjoint(seed for _, seed in seeds)


def test_levels_of_factors_are_combined_and_executed_with_the_same_seeds(tmp_path: Path) -> None:
    for path in (EXAMPLES / "pickplace").iterdir():
        if path.is_file():
            (tmp_path / path.name).write_bytes(path.read_bytes())
    text = 'import "pickplace.bddx"\nStudy s {\n  repeat: 1\n}\n'
    (tmp_path / "p.study").write_text(text, encoding="utf-8")
    plain = load_study(tmp_path / "p.study")
    assert plain.findings == ()
    name = plain.cells[0].plan.files[0].acceptance.executions[0].implementation.iri.rpartition("/")[2]
    levels = f"  factor bhv <{name}>: {{ pick-place, pick }}\n"
    (tmp_path / "p.study").write_text(text.replace("  repeat", f"{levels}  repeat"), encoding="utf-8")
    study = load_study(tmp_path / "p.study")
    messages = [one.message for one in study.findings]
    assert messages == [] or "'pick'" in messages[0], messages
    levels = f"  factor bhv <{name}>: {{ pick-place }}\n"
    (tmp_path / "p.study").write_text(text.replace("  repeat", f"{levels}  repeat"), encoding="utf-8")
    study = load_study(tmp_path / "p.study")
    assert [cell.words for cell in study.cells] == [f"{name}=pick-place"]
    assert [spec.seed for spec in study.cells[0].plan.specs()] == [spec.seed for spec in plain.cells[0].plan.specs()]
    assert study.digest != plain.digest


def test_implementations_of_the_model_are_levels(tmp_path: Path) -> None:
    for path in (EXAMPLES / "ownrobot").iterdir():
        if path.is_file():
            (tmp_path / path.name).write_bytes(path.read_bytes())
    model = tmp_path / "tidy.bddx"
    second = "\nbhv impl (ns=exec) second { py { module: second_version, attr: Carry } }\n"
    model.write_text(model.read_text(encoding="utf-8") + second, encoding="utf-8")
    (tmp_path / "second_version.py").write_bytes((tmp_path / "carrying.py").read_bytes())

    def study(levels: str) -> Study:
        text = f'import "tidy.bddx"\nStudy s {{\nscenarios: {{ <by-our-code> }} factor bhv <ours>: {{ {levels} }} }}'
        (tmp_path / "p.study").write_text(text, encoding="utf-8")
        return load_study(tmp_path / "p.study")

    found = study("<ours>, <second>, <exec:built-in>, pick-place")
    assert found.findings == ()
    assert [cell.words for cell in found.cells] == [
        "ours=<ours>", "ours=<second>", "ours=<exec:built-in>", "ours=pick-place"
    ]  # fmt: skip
    executed = [[one.execution for one in cell.plan.specs()] for cell in found.cells]
    names = [{(one.implementation.kind, one.implementation.name) for one in cell if one} for cell in executed]
    own = [{("python", "carrying:Carry")}, {("python", "second_version:Carry")}]
    assert names == [*own, *[{("catalog", "pick-place")}] * 2]
    assert len({tuple(one.seed for one in cell.plan.specs()) for cell in found.cells}) == 1
    (unknown,) = study("<ours>, <third>").findings
    wanted = "there is no behaviour implementation 'third'; the model has <built-in>, <ours>, <second>"
    assert (unknown.place.column, unknown.message) == (59, wanted)
    (twice,) = study("<ours>, <ours>").findings
    assert twice.message == "the level '<ours>' is given twice: remove one of them"


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("repeats: 3", "3:1 'repeats' is not a setting of a study: did you mean 'repeat'?"),
        ("repeat: 0", "3:9 'repeat' is a whole number from 1 to 1000000, not 0"),
        ("repeat: 1.5", "3:9 'repeat' is a whole number from 1 to 1000000, not 1.5"),
        ("seed: x", "3:7 expected a whole number from 0 to 9223372036854775807, not 'x'"),
        ("block: 3", "3:8 expected 'repetition': all executions of a repetition get the same seed, not '3'"),
        ("traces: some 3 MB", "3:9 a study keeps the traces of 'failures' or of 'all', such as 'failures 500 MB'"),
        ("traces: all 0 MB", "3:13 expected a whole number from 1 to 1000000, not 0"),
        ("traces: all 3", "3:14 expected the unit 'MB', not '}'"),
        ("cover: 90 %", "3:8 expected '{', not '90'"),
        ("cover: { laps 9 % }", f"3:10 {COVERED}"),
        ("cover: { pairs 9 %, pairs 8 % }", f"3:21 {COVERED}"),
        ("cover: { pairs 101 % }", "3:16 expected a number from 1 to 100, not 101"),
        ("cover: { pairs 90 }", "3:19 expected the unit '%', not '}'"),
        ("timeout: 3", "3:11 expected the unit 'seconds', not '}'"),
        ("repeat: 1 repeat: 2", "3:11 'repeat' is given twice: remove one of them"),
        ("first: 1 sample: 2", "3:10 give only one of 'first' and 'sample'"),
        ("where: part", "3:8 expected a condition, such as \"robot=panda\", not 'part'"),
        ("scenarios: { normal }", "3:14 expected a scenario or an execution, such as <normal>, not 'normal'"),
        ("scenarios: { <> }", "3:14 expected a scenario or an execution, such as <normal>"),
        ("factor colour: { red }", "3:8 a factor is 'scene', 'bhv' or 'var': other variables of scenarios vary"),
        ('factor scene: { "a" "b" }', "3:21 expected ',' or '}', not '\"b\"'"),
        ('factor scene: { "a", "a" }', "3:23 the level 'a' is given twice: remove one of them"),
        ("scenarios: { <nothing> }", "3:14 there is no scenario 'nothing'"),
        ('where: "prt=bolt"', "3:9 where, column 1: unknown variable 'prt'"),
        ('where: "part=bullet"', "3:9 no scenario fits the selection"),
        ('factor scene: { "gone.scenex" }', "3:18 there is no file gone.scenex"),
        ("factor bhv <x>: { pick-place }", "3:19 there is no behaviour implementation 'x'"),
    ],
)  # fmt: skip
def test_an_error_is_reported_at_its_place(tmp_path: Path, setting: str, expected: str) -> None:
    (found,) = errors(tmp_path, f"{HEAD}{setting}}}")
    assert found.startswith(expected)


def test_all_errors_of_a_file_are_reported_at_once(tmp_path: Path) -> None:
    text = f'{HEAD}repeat: 0\nfactor scene: {{ 3 }}\nseed: "1"\nfirst: -1\n}}\nStudy two {{}}'
    assert [one.split()[0] for one in errors(tmp_path, text)] == ["3:9", "4:17", "5:7", "6:8", "8:1"]


def test_an_unknown_scenario_is_reported_once_beside_the_errors_of_levels(tmp_path: Path) -> None:
    text = f'{HEAD}scenarios: {{ <gone> }}\nfactor bhv <x>: {{ pick-place }}\nfactor scene: {{ "no.scenex" }}\n}}'
    assert [one.partition(";")[0] for one in errors(tmp_path, text)] == [
        "3:14 there is no scenario 'gone'",
        "4:19 there is no behaviour implementation 'x'",
        "5:18 there is no file no.scenex",
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "1:1 expected 'import' or 'Study', not the end of the file"),
        ("Study s {}", "1:1 a study imports its models"),
        ('import "m.bdd" Study s {', "1:25 expected '}', not the end of the file"),
        ('import "m.bdd" Study {}', "1:22 expected the name of the study, not '{'"),
        ("import m", "1:8 expected the path of a model, such as \"pick.bdd\", not 'm'"),
        ('import "gone.bdd" Study s {}', "1:9 there is no file gone.bdd"),
        ('import "lab.scene" Study s {}', "1:1 the model has no scenario to run"),
    ],
)
def test_the_form_of_the_file_is_checked(tmp_path: Path, text: str, expected: str) -> None:
    study = load_study(write_study(tmp_path, text))
    (found,) = study.findings
    assert f"{found.place.line}:{found.place.column} {found.message}".startswith(expected)
    assert study.cells == ()


def test_errors_of_a_model_are_reported_in_the_model(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path, model="Task (ns=x) t"))
    assert {one.place.file.rpartition("/")[2] for one in study.findings} == {"m.bdd"}


def test_errors_of_form_and_of_content_are_reported_together(tmp_path: Path) -> None:
    text = f'{HEAD}repeat: 0\nscenarios: {{ <gone> }}\nfactor scene: {{ "no.scenex" }}\nsede: 3\n}}'
    assert errors(tmp_path, text) == [
        "3:9 'repeat' is a whole number from 1 to 1000000, not 0",
        "4:14 there is no scenario 'gone'; the model has bench-to-tray",
        "5:18 there is no file no.scenex",
        "6:1 'sede' is not a setting of a study: did you mean 'seed'?",
    ]


def test_what_could_not_be_read_is_not_reported_as_missing(tmp_path: Path) -> None:
    assert errors(tmp_path, f"{HEAD}factor var <part>: from 0.1 to 0.2\ndesign: sobol 3\n}}") == [
        "3:12 the values of 'part' are not numbers: the model gives it env:bolt",
        "4:15 a Sobol design has a power of two of points: write 2 or 4",
    ]
    twice = errors(tmp_path, f"{HEAD}factor bhv <x>: {{ a }} factor bhv <x>: {{ b }}}}")
    assert [one.partition(":")[0] for one in twice] == ["3", "3"]
    assert twice[1].startswith("3:30 this factor is given twice: write all of its levels")
    assert errors(tmp_path, "import m.bdd\nStudy s { }") == [
        "1:8 expected the path of a model, such as \"pick.bdd\", not 'm'"
    ]


def test_check_reports_studies_with_other_models(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_study(tmp_path, f"{HEAD}repeat: 0}}")
    monkeypatch.chdir(tmp_path)
    assert main(["check", "x.study", "m.bdd"]) == 1
    first, *_, last = capsys.readouterr().out.splitlines()
    assert first == "x.study:3:9: error: 'repeat' is a whole number from 1 to 1000000, not 0 [syntax]"
    assert last.startswith("2 files: 1 error")
    write_study(tmp_path)
    assert main(["check", "x.study"]) == 0


def test_check_of_a_folder_includes_its_studies_and_reports_each_error_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_study(tmp_path, f"{HEAD}sample: 0}}")
    monkeypatch.chdir(tmp_path)
    assert main(["check", "."]) == 1
    first, *_, last = capsys.readouterr().out.splitlines()
    assert first == "x.study:3:9: error: 'sample' is a whole number from 1 to 1000000, not 0 [syntax]"
    assert last.startswith("3 files: 1 error")
    write_study(tmp_path, model="Task (ns=x) t")
    assert main(["check", "."]) == 1
    errors = [line for line in capsys.readouterr().out.splitlines() if ": error: " in line]
    assert [line.partition(": error: ")[0] for line in errors] == ["m.bdd:1:10"]
    (tmp_path / "m.bdd").unlink()
    (tmp_path / "lab.scene").unlink()
    assert main(["check", "."]) == 1
    assert capsys.readouterr().out.splitlines()[0] == "x.study:1:9: error: there is no file m.bdd [study]"


def test_format_lays_out_the_studies_of_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = write_study(tmp_path, 'import   "m.bdd"\nStudy s {\nrepeat : 3 // times\n  factor  scene:{"a","b"}\n}')
    assert main(["format", str(tmp_path)]) == 0
    assert f"{study}: changed" in capsys.readouterr().out
    expected = 'import "m.bdd"\nStudy s {\n    repeat: 3  // times\n    factor scene:{"a", "b"}\n}\n'
    assert study.read_text(encoding="utf-8") == expected


def test_a_study_is_no_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = write_study(tmp_path)
    assert main(["run", str(study)]) == 2
    assert "is not a model: its name must end in one of .bdd" in capsys.readouterr().err


def test_a_missing_study_is_no_study(tmp_path: Path) -> None:
    with pytest.raises(NotAModel, match=r"gone\.study cannot be read"):
        load_study(tmp_path / "gone.study")


def test_only_what_changes_executions_changes_the_digest(tmp_path: Path) -> None:
    def digest(text: str) -> str:
        return load_study(write_study(tmp_path, text)).digest

    first = digest(f"{HEAD} seed: 3 }}")
    assert first == digest(f"// A comment.\n{HEAD}\n\n seed:3 }}")
    assert len({first, digest(f"{HEAD} seed: 4 }}"), digest(f"{HEAD} seed: 3 repeat: 2 }}")}) == 3


def test_a_graph_that_a_scene_instance_imports_counts_for_the_digest_and_its_comments_do_not(tmp_path: Path) -> None:
    for path in (EXAMPLES / "study").iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    scene = tmp_path / "bench.scenex"
    scene.write_text(f'import "more.ttl"\n{scene.read_text(encoding="utf-8")}', encoding="utf-8")
    text = 'import "study.bdd" Study s { factor scene: { "bench.scenex" } }'
    (tmp_path / "s.study").write_text(text, encoding="utf-8")

    def digest(graph: str) -> str:
        (tmp_path / "more.ttl").write_text(graph, encoding="utf-8")
        study = load_study(tmp_path / "s.study")
        assert study.findings == ()
        return study.digest

    first = digest("<https://example.org/part> <https://example.org/weighs> 1 .")
    assert first == digest("# A comment.\n<https://example.org/part>  <https://example.org/weighs> 1 .")
    assert first != digest("<https://example.org/part> <https://example.org/weighs> 2 .")
