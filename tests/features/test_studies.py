"""Completion, hover, outline and folds in a study. ``$0`` is the cursor."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import EXAMPLES, FOLDER, MODEL, SCENE
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.completion import complete
from robbdd_tools.features.describe_entry import describe_entry
from robbdd_tools.features.folding import folds
from robbdd_tools.features.hover import hover
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.features.outline import Item, outline
from robbdd_tools.features.studies import study_name_at, uses_in_study
from robbdd_tools.features.study_words import FORMS, WHOLE
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.study_text import SETTINGS, read_study

URI = f"{FOLDER}x.study"
HEAD = 'import "main.bdd"\nStudy s {\n'


def project(text: str) -> Project:
    opened = Project()
    for name, content in {"lab.scene": SCENE, "main.bdd": MODEL, "x.study": text}.items():
        opened.open(f"{FOLDER}{name}", 1, content)
    return opened


def proposals(text: str) -> list[Completion]:
    return complete(project(text.replace("$0", "")).snapshot(), URI, text.index("$0"))


def labels(text: str) -> list[str]:
    return [one.label for one in proposals(text)]


def accepted(text: str) -> str:
    """Return the text after the first proposal was accepted."""
    first = proposals(text)[0]
    plain = text.replace("$0", "")
    return plain[: first.whole.start] + first.text + plain[first.whole.end :]


def test_a_study_begins_with_an_import_or_as_a_whole() -> None:
    assert labels("$0") == ["Study …", "import", "Study"]
    assert labels('import "main.bdd"\nSt$0') == ["import", "Study"]
    assert labels("import $0") == []


def test_the_form_of_a_whole_study_is_one() -> None:
    content, faults = read_study(Document(URI, 0, WHOLE.plain))
    assert (content.name, content.numbers, faults) == ("name", {"repeat": 10, "seed": 1}, [])


def test_the_settings_that_are_missing_are_proposed() -> None:
    assert labels(f"{HEAD}$0\n}}") == list(SETTINGS)
    expected = [one for one in SETTINGS if one not in ("repeat", "first", "sample", "pairwise")]
    assert labels(f"{HEAD}repeat: 3 sample: 2 re$0\n}}") == expected
    assert labels(f"{HEAD}factor bhv <x>: {{ a }} $0") == list(SETTINGS)
    assert accepted(f"{HEAD}scen$0 }}") == f"{HEAD}scenarios: {{  }}"


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("factor $0", ["scene", "bhv", "var"]),
        ("factor var $0", ["goal", "part", "robot"]),
        ("factor var <part>: from 1 to 2 factor var $0", ["goal", "robot"]),
        ("factor var <part>: $0", ["from"]),
        ("factor var <part>: from $0", []),
        ("factor var <part>: from 0.7 m $0", ["to"]),
        ("design: $0", ["latin-hypercube", "sobol", "grid"]),
        ("design: sobol $0", []),
        ("factor scene $0", []),
        ("stop: $0", ["width", "rate"]),
        ("stop: rate 0.9 $0", ["against"]),
        ("stop: rate 0.9 against $0", []),
        ("timeout: 20 $0", ["seconds"]),
        ("repeat: $0", []),
        ("cover: { $0", ["levels", "pairs", "clauses", "events", "predicates"]),
        ("cover: { pairs 90 %, cl$0", ["levels", "clauses", "events", "predicates"]),
        ("cover: { pairs $0", []),
        ("cover: { pairs 90 $0", ["%"]),
        ("scenarios: { $0 }", ["bench-to-tray"]),
        ("scenarios: { <bench-to-tray>, $0 }", []),
        ("scenarios $0", []),
        ("// re$0", []),
        ('where: "a" // $0', []),
    ],
)
def test_values_of_settings_are_proposed(setting: str, expected: list[str]) -> None:
    assert labels(f"{HEAD}{setting}") == expected


def test_a_setting_may_follow_each_complete_one() -> None:
    for setting in (
        "stop: width 0.1",
        "factor var <part>: from 0.5 m to 0.7 m",
        "design: grid 3",
        "stop: rate 0.9 against 0.8",
        "timeout: 3 seconds",
        "scenarios: { <a> }",
        "cover: { pairs 90 % }",
        "seed: 1",
    ):
        assert "batch" in labels(f"{HEAD}{setting} $0")


@pytest.mark.parametrize("typed", ["$0", "<$0", "<be$0", "<be$0>", "<$0>", "<be$0nch>"])
def test_a_name_is_proposed_with_its_brackets_once(typed: str) -> None:
    assert accepted(f"{HEAD}scenarios: {{ {typed} }} }}") == f"{HEAD}scenarios: {{ <bench-to-tray> }} }}"


def test_a_proposed_scenario_is_described() -> None:
    (found,) = proposals(f"{HEAD}scenarios: {{ $0 }} }}")
    assert found.origin is not None
    described = describe_entry(project("").snapshot(), found.kind, *found.origin)
    assert described is not None
    assert described.startswith("**scenario variant**")


def test_catalog_behaviours_are_levels() -> None:
    behaviours = sorted(load_catalog().behaviours)
    assert labels(f"{HEAD}factor bhv <x>: {{ $0") == behaviours
    others = [one for one in behaviours if one != "pick-place"]
    assert labels(f"{HEAD}factor bhv <x>: {{ pick-place, $0 }}") == others


def test_implementations_and_executions_of_a_model_are_proposed() -> None:
    stored = next((EXAMPLES / "pickplace").glob("*.bddx"))
    name = stored.read_text(encoding="utf-8").partition("bhv impl (ns=")[2].partition(") ")[2].split()[0]
    uri = path_to_uri(stored.parent / "x.study")
    opened = Project()

    def at(text: str) -> list[str]:
        opened.open(uri, 1, text.replace("$0", ""))
        return [one.label for one in complete(opened.snapshot(), uri, text.index("$0"))]

    assert name in at(f'import "{stored.name}" Study s {{ factor bhv $0')
    assert {name, "pick-place"} <= {*at(f'import "{stored.name}" Study s {{ factor bhv <x>: {{ $0')}
    assert name not in at(f'import "{stored.name}" Study s {{ factor bhv <x>: {{ <{name}>, $0')
    text = f'import "{stored.name}" Study s {{ factor bhv <x>: {{ pick-place, <{name}> }} }}'
    opened.open(uri, 2, text)
    named = study_name_at(opened.snapshot(), uri, text.index(name) + 1)
    assert named is not None
    assert named[1].symbol.name == name
    assert len(at(f'import "{stored.name}" Study s {{ scenarios: {{ $0')) >= 2


def test_files_are_proposed_by_what_the_place_wants(tmp_path: Path) -> None:
    for name in ("a.bdd", "b.bddx", "c.scenex", "d.txt", "in/e.bdd"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("", encoding="utf-8")
    uri = path_to_uri(tmp_path / "x.study")

    def at(text: str) -> list[str]:
        opened = Project()
        opened.open(uri, 1, text.replace("$0", ""))
        return [one.label for one in complete(opened.snapshot(), uri, text.index("$0"))]

    assert at('import "$0') == ["a.bdd", "b.bddx", "in/"]
    assert at('import "in/$0"') == ["e.bdd"]
    assert at('import "a.bdd" Study s { factor scene: { "$0') == ["c.scenex", "in/"]
    assert at('import "a.bdd" Study s { where: "$0') == []


def test_each_setting_is_described_and_its_form_is_read() -> None:
    assert set(FORMS) == {*SETTINGS, "import", "Study"}
    for name in SETTINGS:
        text = f"{HEAD}{name}$0".replace("$0", "")
        shown = hover(project(text).snapshot(), URI, len(text))
        assert shown is not None
        assert shown.markdown.endswith(FORMS[name][1])
        for line in FORMS[name][0].splitlines():
            values = {
                "<NAME>": "<a>",
                "<IMPL>": "<a>",
                "<VARIABLE>": "<a>",
                "A to B": "0.1 to 0.2",
                ", …": "",
                "NAME": "a",
                "Q": "0.1",
                "P": "0.2",
                "W": "0.2",
            }
            for word, value in values.items():
                line = line.replace(word, value)
            line = line.replace(" N", " 4")
            assert read_study(Document(URI, 0, f"{HEAD}{line} }}"))[1] == [], line


def test_the_variable_of_a_range_leads_to_its_declaration_and_to_its_template() -> None:
    text = f"{HEAD}factor var <fetch.part>: from 1 to 2\nfactor var <goal>: from 1 to 2 }}"
    snapshot = project(text).snapshot()
    for word, kind in (("part", "variable"), ("fetch", "scenario template"), ("goal", "variable")):
        found = study_name_at(snapshot, URI, text.index(word) + 1)
        assert found is not None
        assert (text[found[0].start : found[0].end], str(found[1].kind)) == (word, kind)
        assert found[0] in list(uses_in_study(snapshot, URI, found[1]))


def test_a_level_that_is_called_like_a_setting_is_not_described_as_one() -> None:
    text = f"{HEAD}factor bhv <x>: {{ pick-place, seed }} }}"
    snapshot = project(text).snapshot()
    level = hover(snapshot, URI, text.index("pick-place") + 2)
    assert level is not None
    assert "picks" in level.markdown
    assert hover(snapshot, URI, text.index("seed") + 1) is None


def test_the_outline_has_the_settings_and_factors() -> None:
    factors = 'factor bhv <my-server>: { a }\nfactor scene: { "a.scenex" }\nfactor var <part>: from 1 to 2'
    text = f"{HEAD}repeat: 3\n{factors}\n}}\n"
    (study,) = outline(project(text).snapshot(), URI)

    def names(item: Item) -> list[tuple[str, str]]:
        return [(one.name, one.kind) for one in item.children]

    assert (study.name, study.kind) == ("s", "study")
    assert names(study) == [("repeat", "repeat"), ("my-server", "factor"), ("scene", "factor"), ("part", "factor")]
    assert all(study.extent.start <= one.span.start and one.span.end <= study.extent.end for one in study.children)
    assert outline(project("Study").snapshot(), URI) == []


def test_a_study_and_its_long_lists_can_be_folded() -> None:
    text = 'import "a.bdd"\nimport "b.bdd"\nStudy s {\n    scenarios: {\n        <a>,\n        <b>\n    }\n}\n'
    found = [(one.first, one.last, one.kind) for one in folds(project(text).snapshot(), URI)]
    assert found == [(0, 1, "imports"), (2, 6, "region"), (3, 5, "region")]


@pytest.mark.parametrize(
    "text", ["", "Study", "Study s", "Study s {", '"', "<", "import", "}", "factor", "Study s { stop: rate }"]
)
def test_half_typed_text_is_no_error(text: str) -> None:
    for offset in range(len(text) + 1):
        snapshot = project(text).snapshot()
        complete(snapshot, URI, offset)
        hover(snapshot, URI, offset)
        outline(snapshot, URI)
