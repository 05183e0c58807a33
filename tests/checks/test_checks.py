"""Each rule beyond syntax, names and shapes finds its mistake and no other."""

import pytest

from kit import MODEL, assert_diagnostics, fixture
from robbdd_tools.features.diagnostics import fast_diagnostics


def check(text: str) -> None:
    case = fixture(text)
    assert_diagnostics(fast_diagnostics(case.snapshot, case.uri), case)


def test_a_sound_model_breaks_no_rule() -> None:
    check(MODEL)


@pytest.mark.parametrize("text", ["ns t = 'https://x/'", "Scenario Template", "", "// nothing"])
def test_a_file_without_a_scenario_says_that_there_is_nothing_to_run(text: str) -> None:
    case = fixture(text)
    codes = [entry.code for entry in fast_diagnostics(case.snapshot, case.uri) if entry.code != "syntax"]
    assert codes == ["no-scenario"]


def test_a_scene_needs_no_scenario() -> None:
    case = fixture("//- lab.scene\nns e = 'https://x/'\n")
    assert fast_diagnostics(case.snapshot, case.uri) == []


@pytest.mark.parametrize("iri", ["lab/", "", "1http://x/", "http://x/ y", "http://x/<y>"])
def test_a_namespace_must_be_an_absolute_iri(iri: str) -> None:
    case = fixture(f"//- lab.scene\nns e = '{iri}'\n")
    assert [entry.code for entry in fast_diagnostics(case.snapshot, case.uri)] == ["namespace-iri"]


@pytest.mark.parametrize("iri", ["https://example.org/a/", "urn:example:", "http://ex.org/ü#"])
def test_every_absolute_iri_will_do(iri: str) -> None:
    case = fixture(f"//- lab.scene\nns e = '{iri}'\n")
    assert fast_diagnostics(case.snapshot, case.uri) == []
