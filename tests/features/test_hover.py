"""Hover shows what a name is, what it generates, and its results."""

from __future__ import annotations

import textwrap

import pytest

from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE, fixture
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.describe import describe_path, describe_words
from robbdd_tools.features.hover import hover
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import NOTHING, Findings, JudgedScenario, Judgement, digests_of


def shown(text: str, findings: Findings = NOTHING) -> str:
    case = fixture(text)
    found = hover(case.snapshot, case.uri, case.cursor, findings)
    return "" if found is None else found.markdown


def at(word: str, text: str = MODEL) -> str:
    assert word.replace("$0", "") in text
    return shown(text.replace(word.replace("$0", ""), word, 1))


def test_a_clause_tells_its_sentence_its_meaning_and_when_it_is_judged() -> None:
    found = at("in-$0tray: holds")
    assert "> `<part>` is located at `<goal>` for 0.5 seconds after place-end" in found
    assert load_catalog().predicates["located-at"].doc in found
    assert "a margin in m" in found
    assert "Judged throughout the 0.5 s that begin at `place-end`." in found


def test_a_behaviour_tells_its_sentence_and_its_events() -> None:
    found = at("Behaviour (ns=t) car$0ry")
    assert "> `<robot>` picks `<part>` and places" in found
    assert "Events: " in found


def test_a_variant_and_its_template_tell_how_many_scenarios_there_are() -> None:
    assert "4 scenarios (2 × 1 × 2)" in at("Scenario bench-$0to-tray")
    assert "`bench-to-tray`: 4 scenarios (2 × 1 × 2)" in at("template: <fe$0tch>")
    rows = MODEL[MODEL.index("                var <fetch.part>") :].rpartition("        }")[0]
    table = "| <fetch.part> |\n|---|\n| <parts.bolt> |\n"
    assert "1 scenario" in at("Scenario bench-$0to-tray", MODEL.replace(rows, table))
    assert "some are unknown" in at("Scenario bench-$0to-tray", MODEL.replace("obj set <parts>", "obj set <gone>"))


def test_a_variable_tells_its_type_and_where_it_is_used() -> None:
    assert at("var pa$0rt").split("\n\n")[0] == "**variable** `fetch.part`: object"
    assert at("var pa$0rt").endswith("used 4 times: main.bdd:15, main.bdd:19, main.bdd:22, main.bdd:31")


def test_the_comment_above_a_declaration_is_shown() -> None:
    text = MODEL.replace("Event (ns=t) start", "// When the operator\n// lets go.\nEvent (ns=t) start")
    assert "When the operator\nlets go." in at("duration: from <st$0art>", text)
    assert "not used" in at("Event (ns=t) spa$0re", MODEL + "Event (ns=t) spare\n")


def test_what_looks_like_a_tag_in_a_comment_is_shown() -> None:
    text = MODEL.replace(
        "Event (ns=t) start", "// As <inertial> says, see `<mass>` and <https://example.org>.\nEvent (ns=t) start"
    )
    assert "As `<inertial>` says, see `<mass>` and <https://example.org>." in at("duration: from <st$0art>", text)


def test_a_part_of_a_scene_instance_is_quoted() -> None:
    joint = "fixed lies-on {\n    parent: <floor.ground>\n    child: <floor.ground>\n}"
    inside = textwrap.indent(joint.replace("lies", "li$0es"), " " * 8)
    text = f"ktree cell {{\n    body floor {{ frame ground {{ }} }}\n    joints {{\n{inside}\n    }}\n}}\n"
    assert f"```robbdd-ktree\n{joint}\n```" in shown(f"//- main.ktree\n{text}")


def test_an_import_tells_what_the_file_declares() -> None:
    found = at('"lab.sc$0ene"').split("\n\n")
    assert found[0] == "**file** `lab.scene`"
    assert found[1].startswith("declares object set `parts`, object set `washers`, ")
    assert at('"gone.sc$0ene"', MODEL.replace("lab.scene", "gone.scene")) == ""


def test_elements_tell_what_simulates_them() -> None:
    assert "Simulated as *franka-panda*" in at("<arms.pan$0da>")
    scene = f"//- main.scene\n{SCENE}"
    assert "Simulated as *tray*" in shown(scene.replace("object tray", "object tr$0ay"))
    assert "8 elements: `arms.panda`" in at("scene: <bench_$0scene>")


@pytest.mark.parametrize(
    ("old", "new", "meaning"),
    [
        ("before <pick-start>)", "be$0fore <pick-start>)", "Judged at the last sample at or before `pick-start`."),
        ("before <pick-start>)", "2 sec$0onds before <pick-start>)", "Judged throughout the 2 s that end at"),
        ("before <pick-start>)", "fr$0om <pick-start> until <end>)", "from `pick-start` until `end`, both included"),
        (
            "before <pick-start>)",
            "with$0in <part> seconds before <pick-start>)",
            "at some time in the <part> s that end",
        ),
        ("before <pick-start>)", "with$0in 2 seconds before <pick-start>)", "at some time in the 2 s that end at"),
        ("before <pick-start>)", "bef$0ore every <pick-start>)", "at the last sample at or before every `pick-start`."),
        ("before <pick-start>)", "at so$0me time from <pick-start> until <end>)", "it must hold at some time."),
    ],
)
def test_a_time_constraint_tells_when_it_is_judged(old: str, new: str, meaning: str) -> None:
    assert meaning in shown(MODEL.replace(old, new, 1))


def test_a_clause_with_a_condition_tells_when_it_is_judged() -> None:
    condition = "is located at <goal> whenever <part> is held by <robot>, from <start> until <end>)"
    text = MODEL.replace("is located at <goal>, 0.5 seconds after <place-end>)", condition, 1)
    assert text != MODEL
    found = at("in-$0tray: holds", text)
    assert "> `<part>` is located at `<goal>` whenever `<part>` is held by `<robot>` from start until end" in found
    assert "Judged only at the samples at which this holds" in found


def test_the_last_results_of_a_clause_are_shown_worst_first() -> None:
    case = fixture(MODEL)
    iri = "https://example.org/t/in-tray"
    told = digests_of(case.snapshot, case.uri).clauses[iri]
    held = Judgement("in-tray", "holds", "+12 mm", 2.0, "✔ +12 mm", told)
    failed = Judgement("in-tray", "violated", "−3 mm", 0.0, "✗ −3 mm at 2.00 s", told)
    scenarios = [
        JudgedScenario(case.uri, "v", number, f"part = {part}", "", "", {iri: judgement}, True)
        for number, (part, judgement) in enumerate((("nut", held), ("bolt", failed)))
    ]
    findings = findings_of(scenarios)
    found = shown(MODEL.replace("in-tray: holds", "in-$0tray: holds"), findings)
    assert "Last results:\n\n- part = bolt: ✗ −3 mm at 2.00 s\n- part = nut: ✔ +12 mm" in found
    clause = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
    for word in ("holds", "part", "located", "goal", "seconds", "place-end"):
        inside = shown(MODEL.replace(clause, clause.replace(word, f"{word[0]}$0{word[1:]}")), findings)
        assert inside.count("Last results:\n\n- part = bolt: ✗ −3 mm at 2.00 s") == 1, word
    assert "Last results" not in shown(MODEL.replace("var part", "var pa$0rt"), findings)
    edited = shown(MODEL.replace("in-tray: holds", "in-$0tray: holds").replace("0.5 seconds", "0.6 seconds"), findings)
    assert "before the text was edited" in edited


@pytest.mark.parametrize(
    ("text", "title"),
    [
        ("//- main.ktree\nns x = 'http://x/'\nktree (ns=x) arm { body ba$0se { frame f { } } }", "**body** `arm.base`"),
        (
            "//- main.scenex\nimport 'lab.scene'\nns x = 'http://x/'\nscene inst (ns=x) s { scene: <bench_sc$0ene> }",
            "**scene** `bench_scene`",
        ),
        (
            "//- main.bddx\nns x = 'http://x/'\nbhv impl (ns=x) pi$0ck { catalog 'pick' }",
            "**behaviour implementation**",
        ),
        ("//- main.bdd\nns t = 'http://x/'\nTask (ns=t) ta$0sk\nScenario Template (ns=t) x {{{", "**task** `task`"),
    ],
)
def test_every_file_kind_and_broken_text_are_explained(text: str, title: str) -> None:
    assert shown(text).startswith(title)


def test_completions_are_explained_by_path_and_by_words() -> None:
    case = fixture(MODEL)
    assert (describe_path(case.snapshot, "file:///fixture/lab.scene", "parts.bolt") or "").startswith("**object**")
    assert describe_path(case.snapshot, case.uri, "gone") is None
    assert load_catalog().predicates["located-at"].doc in (describe_words("is located at") or "")
    assert describe_words("Scenario") is None


def test_a_node_of_a_behaviour_tree_tells_what_it_does_and_what_is_linked_to_it() -> None:
    tree = "Behaviour Tree (ns=t) handling { sequence who$0le { node pick node place } }\n"
    link = "places at <goal>\n            node: <handling.whole>\n        }"
    text = EVENTS + tree + TEMPLATE.replace("places at <goal>\n        }", link) + STORY
    assert shown(text).splitlines()[2:5] == [
        "Executes `pick`, `place`, one after the other, until one fails.",
        "",
        "`carry`: `<robot>` picks `<part>` and places it at `<goal>`",
    ]
