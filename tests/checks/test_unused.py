"""Rules about unused names; names that another file may use are not reported."""

import pytest

from checks.models import check, fixed, found
from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Severity

SPARE = "    var spare\n"


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("Event (ns=t) spare\n", "unused-event"),
        ("Task (ns=t) spare\n", "unused-task"),
        ("Predicate (ns=t) <one> is-spare in <place>: ( <one> is located at <place> )\n", "unused-predicate"),
        ("const set (ns=t) spare { <parts.bolt> }\n", "unused-set"),
    ],
)
def test_what_nobody_uses_is_a_hint_and_can_go(line: str, code: str) -> None:
    text = EVENTS + line + TEMPLATE + STORY
    (finding,) = found(text)
    assert (finding.code, finding.severity) == (code, Severity.HINT)
    assert fixed(text, code) == MODEL


@pytest.mark.parametrize("line", ["Event (ns=t) spare\n", "Task (ns=t) spare\n", "const set (ns=t) spare { 1 }\n"])
def test_a_file_without_stories_is_a_library(line: str) -> None:
    assert [entry.code for entry in found(EVENTS + line + TEMPLATE)] == ["no-scenario"]


def test_what_an_importer_uses_is_used_and_only_that() -> None:
    text = "//- main.bdd\n" + EVENTS + "Event (ns=t) spare\n" + TEMPLATE + STORY
    text += "//- other.bdd\nimport \"main.bdd\"\nns u = 'https://example.org/u/'\n"
    user = "Scenario Template (ns=u) late {\n    duration: from <spare> until <spare>\n}\n"
    assert "unused-event" not in {entry.code for entry in found(text + user)}
    assert "unused-event" in {entry.code for entry in found(text + "Task (ns=u) other\n")}


def test_a_name_in_a_broken_declaration_is_used() -> None:
    text = EVENTS + "Event (ns=t) spare\n" + TEMPLATE + STORY + "Scenario Template (ns=t) broken {\n task <spare> }\n"
    assert {entry.code for entry in found(text)} == {"syntax"}


def test_an_import_of_which_nothing_is_used_is_a_hint() -> None:
    other = "//- other.scene\nns x = 'https://example.org/x/'\nobj set (ns=x) things { object thing }\n"
    text = '//- main.bdd\nimport "other.scene"\n//      ^^^^^^^^^^^ unused-import remove this import\n' + MODEL
    check(text + other)
    assert fixed(text + other, "unused-import").endswith(MODEL)


def test_an_import_is_used_through_what_it_imports() -> None:
    other = '//- other.scene\nimport "lab.scene"\n//- lab.scene\n' + SCENE
    check("//- main.bdd\n" + MODEL.replace("lab.scene", "other.scene") + other)


def test_files_that_import_each_other_use_each_other() -> None:
    other = "//- other.bdd\nimport \"main.bdd\"\nns o = 'https://example.org/o/'\nEvent (ns=o) extra\n"
    text = MODEL.replace('import "lab.scene"', 'import "other.bdd"\nimport "lab.scene"').replace(
        "until <place-end>", "until <extra>"
    )
    assert [entry.code for entry in found("//- main.bdd\n" + text + other)] == ["cyclic-import"]


@pytest.mark.parametrize("rest", ["", "ns t = 'https://example.org/t/'\nEvent (ns=t) end\n"])
def test_a_library_hands_its_imports_on(rest: str) -> None:
    assert [entry.code for entry in found(f'//- all.bdd\nimport "lab.scene"\n{rest}')] == ["no-scenario"]


def test_a_broken_import_may_declare_anything() -> None:
    other = "//- other.scene\nns x = 'https://example.org/x/'\nobj set (ns=x) things { object }\n"
    text = '//- main.bdd\nimport "other.scene"\n' + MODEL + other
    assert [entry.code for entry in found(text)] == ["broken-import"]


def test_a_variable_that_no_clause_speaks_of_can_go() -> None:
    text = EVENTS + TEMPLATE.replace("    var goal\n", "    var goal\n" + SPARE) + STORY
    findings = found(text)
    assert [entry.code for entry in findings] == ["unused-variable", "missing-value"]
    assert fixed(text, "unused-variable") == MODEL


def test_varying_an_unused_variable_is_a_warning_without_a_fix() -> None:
    story = STORY.replace("variation:\n", "variation:\n                var <fetch.spare>: { 1, 2 }\n")
    (finding,) = found(EVENTS + TEMPLATE.replace("    var goal\n", "    var goal\n" + SPARE) + story)
    assert (finding.code, finding.severity, finding.fixes) == ("unused-variable", Severity.WARNING, ())


def test_a_variable_may_be_used_by_a_variant_only() -> None:
    story = STORY.replace(
        "variation:\n",
        "Then: also: holds(<fetch.robot> has config seed = <fetch.spare>, after <end>)\n"
        "variation:\n                var <fetch.spare>: { 1, 2 }\n",
    )
    check(EVENTS + TEMPLATE.replace("    var goal\n", "    var goal\n" + SPARE) + story)


def test_a_quantified_variable_is_used() -> None:
    fluent = "also: holds(<fetch.part> is held by <fetch.robot>, after <end>)"
    clause = f"Then: ( var z exists in <parts> ) such that {{ {fluent} }}"
    text = EVENTS + TEMPLATE + STORY.replace("variation:", clause + "\n variation:")
    (finding,) = found(text)
    assert (finding.code, finding.severity) == ("unused-variable", Severity.HINT)
    assert text[finding.span.start : finding.span.end] == "z"
