"""The published form is offered to be written in the current one, with nothing lost."""

from itertools import count

import pytest

from kit import MODEL, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.split import split
from syntax.test_published import CURRENT, PUBLISHED, SCENE_IMPORT, graph, shape


def hints(text: str) -> tuple[Project, str, list[Diagnostic]]:
    case = fixture(text)
    found = fast_diagnostics(case.snapshot, case.uri)
    return case.project, case.uri, [entry for entry in found if entry.code == "published-form"]


def rewritten(text: str) -> str:
    """The text with every fix applied."""
    _, _, found = hints(text)
    edits = [edit for entry in found for edit in entry.fixes[0].edits]
    for edit in sorted(edits, key=lambda edit: edit.span.start, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


def words(text: str) -> list[str]:
    for sign in "(){}<>:,":
        text = text.replace(sign, f" {sign} ")
    return text.split()


def test_the_rewritten_text_is_the_current_form() -> None:
    text = rewritten(SCENE_IMPORT + PUBLISHED)
    assert words(text) == words(SCENE_IMPORT + CURRENT)
    assert hints(text)[2] == []


def test_the_rewritten_text_means_the_same() -> None:
    text = rewritten(SCENE_IMPORT + PUBLISHED).removeprefix(SCENE_IMPORT)
    assert graph(text) == graph(PUBLISHED)


def test_each_declaration_is_a_hint_of_its_own() -> None:
    _, _, found = hints(SCENE_IMPORT + PUBLISHED)
    assert [entry.message.split("'")[1] for entry in found] == ["pickup_start", "place_end", "fetch", "fetching"]
    assert {entry.severity for entry in found} == {Severity.HINT}


def test_the_current_form_has_no_hint() -> None:
    assert hints(MODEL)[2] == []
    assert hints(SCENE_IMPORT + CURRENT)[2] == []


def test_comments_stay() -> None:
    numbers = count()
    text = "".join(f"{line} // note {next(numbers)}\n" for line in (SCENE_IMPORT + PUBLISHED).splitlines())
    changed = rewritten(text)
    lost = [note for note in range(next(numbers)) if f"// note {note}\n" not in changed]
    assert lost == []
    assert graph(changed.removeprefix(SCENE_IMPORT)) == graph(PUBLISHED)


@pytest.mark.parametrize(
    ("published", "current"),
    [
        (
            "Given: ( not <a> can reach <b> before <e> )",
            "Given: ( not x-given-1: holds(<a> can reach <b>, before <e>) )",
        ),
        (
            "Given: ( <a> can reach <b> before <e> or k: holds(<a> can reach <b>, before <e>) ) "
            "<a> can reach <b> after <e>",
            "Given: ( ( x-given-1: holds(<a> can reach <b>, before <e>) or k: holds(<a> can reach <b>, before <e>) ) "
            "and x-given-2: holds(<a> can reach <b>, after <e>) )",
        ),
        ('Given: "it is dark" before <e>', 'Given: "it is dark" before <e>'),
    ],
)
def test_expressions_keep_their_structure(published: str, current: str) -> None:
    end = "When: Behaviour (ns=t) b { duration: from <e> until <f> <a> picks <b> } }"
    head = "ns t = 'https://example.org/t/'\nScenario Template (ns=t) x { var a var b "
    changed = rewritten(f"{head}{published} {end}")
    assert words(changed) == words(f"{head}{current} {end}")
    pieces = [split("bdd", text)[-1].text for text in (changed, f"{head}{current} {end}")]
    assert len({repr(shape(parse_declaration("bdd", piece).tree)) for piece in pieces}) == 1


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (
            "When: Behaviour b { <a> picks <o> and places it at <w> }",
            "When: Behaviour (ns=t) b { duration: from <s> until <e> <a> picks <o> and places at <w> }",
        ),
        (
            "When: <a> picks <o> from <s> until <e>",
            "duration: from <s> until <e> When: Behaviour (ns=t) x-pick { duration: from <s> until <e> <a> picks <o> }",
        ),
    ],
)
def test_behaviours_are_written_out(written: str, expected: str) -> None:
    head = "ns t = 'https://example.org/t/'\nScenario Template (ns=t) x { "
    then = " Then: f: holds(<a> can reach <o>, from <s> until <e>) }"
    assert words(rewritten(head + written + then)) == words(head + expected + then)


def test_a_broken_declaration_is_left_alone() -> None:
    assert hints("ns t = 'https://example.org/t/'\nScenario Template x { Given: <a> can rech <b> before <e> }")[2] == []
