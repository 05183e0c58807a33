"""Two declarations must not have one IRI."""

from checks.models import check, found
from kit import EVENTS, MODEL, STORY, TEMPLATE


def test_equal_clause_names_in_one_namespace_are_one_thing_too_many() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("in-tray", "at-tray")
    text = (
        EVENTS
        + TEMPLATE
        + other.replace(
            "before <pick-start>)\n",
            "before <pick-start>)\n//      ^^^^^^^^ duplicate-iri 'on-bench' is already the name of something else\n",
        )
    )
    check(text + STORY)


def test_two_namespaces_may_have_one_name() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("Template (ns=t)", "Template (ns=o)")
    check(EVENTS.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =") + TEMPLATE + other + STORY)


def test_two_names_of_one_namespace_are_one_namespace() -> None:
    text = EVENTS.replace("ns t =", "ns o = 'https://example.org/t/'\nns t =") + TEMPLATE + STORY
    text += "const set (ns=o) fetch { 1 }\n"
    assert [entry.code for entry in found(text) if entry.code == "duplicate-iri"] == []
    clash = text.replace("const set (ns=o) fetch", "const set (ns=o) on-bench")
    (finding,) = found(clash, "duplicate-iri")
    assert clash[finding.span.start : finding.span.end] == "on-bench"


def test_an_imported_file_has_the_iri_already() -> None:
    other = "//- events.bdd\nns e = 'https://example.org/t/'\nEvent (ns=e) end\n"
    text = MODEL.replace('import "lab.scene"', 'import "events.bdd"\nimport "lab.scene"')
    (finding,) = found("//- main.bdd\n" + text + other, "duplicate-iri")
    assert text[finding.span.start : finding.span.end] == "end"
    assert finding.related[0].uri.endswith("events.bdd")


def test_members_of_similar_sets_do_not_clash_with_each_other() -> None:
    check("//- lab.scene\nns e = 'https://x/'\nsimilar obj set (ns=e) balls { base name: ball  count: 3 }\n")


def test_a_variable_is_shared_by_name() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("on-bench", "at-b").replace("in-tray", "at-t")
    check(EVENTS + TEMPLATE + other + STORY)


def test_a_declaration_without_a_namespace_has_that_of_its_file() -> None:
    text = MODEL + "const set end { 1 }\n"
    assert [entry.code for entry in found(text, "duplicate-iri")] == []
    clash = text.replace("const set end", "const set on-bench")
    (finding,) = found(clash, "duplicate-iri")
    assert clash[finding.span.start : finding.span.end] == "on-bench"
