"""A preview shows the features of a text and leads back from their lines."""

from __future__ import annotations

from gherkin_kit import edited, feature
from kit import MODEL, fixture
from robbdd_tools.gherkin.preview import Preview, preview

TABLE = edited(
    """var <fetch.part>: obj set <parts>
                var <fetch.robot>: { <arms.panda> }
                var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }""",
    """| <fetch.part> | <fetch.robot> | <fetch.goal> |
                |---|---|---|
                | <parts.bolt> | <arms.panda> | <places.tray_ws> |
                | <parts.nut> | <arms.ur10> | <places.tray_ws> |""",
)
SECOND = """User Story (ns=t) again {
    As A "o" I Want "p" So That "w"
    Scenarios:
        Scenario once-more {
            template: <fetch>
            scene: <bench_scene>
            variation:
                var <fetch.part>: { <parts.nut> }
                var <fetch.robot>: { <arms.panda> }
                var <fetch.goal>: { <places.tray_ws> }
        }
}
"""


def previewed(text: str, variant: str | None = None, most: int = 50) -> Preview:
    case = fixture(text)
    return preview(case.snapshot, case.uri, variant, most)


def leads(text: str, made: Preview) -> list[tuple[str, str]]:
    """Each mapped line of a preview with the beginning of the text it leads to."""
    lines = made.text.split("\n")
    places = [(lines[entry.line].strip(), entry.location.span) for entry in made.lines]
    return [(line.partition(" ")[0], " ".join(text[span.start : span.end].split())[:22]) for line, span in places]


def test_a_preview_is_the_feature_that_would_be_written() -> None:
    made = previewed(MODEL)
    assert made.text == feature(MODEL)
    assert (made.shown, made.total) == (4, 4)


def test_each_line_leads_to_its_whole_clause_and_a_heading_to_its_variant() -> None:
    assert leads(MODEL, previewed(MODEL))[:4] == [
        ("Scenario:", "Scenario bench-to-tray"),
        ("Given", "on-bench: holds(<part>"),
        ("When", "Behaviour (ns=t) carry"),
        ("Then", "in-tray: holds(<part> "),
    ]


def test_a_heading_leads_to_the_row_of_its_table() -> None:
    found = [place for line, place in leads(TABLE, previewed(TABLE)) if line == "Scenario:"]
    assert found == ["| <parts.bolt> | <arms", "| <parts.nut> | <arms."]


def test_a_large_variation_shows_its_beginning_and_says_how_much_there_is() -> None:
    digits = ", ".join(map(str, range(1000)))
    many = edited("{ <arms.panda> }", f"{{ {digits} }}")
    made = previewed(many, most=3)
    assert (made.shown, made.total) == (3, 4000)
    assert made.text.count("Scenario:") == 3


def test_several_stories_stand_one_below_the_other_and_a_scenario_alone() -> None:
    both = MODEL + SECOND
    made = previewed(both)
    assert made.text.count("Feature:") == 2
    assert leads(both, made)[-4:] == [
        ("Scenario:", "Scenario once-more { t"),
        ("Given", "on-bench: holds(<part>"),
        ("When", "Behaviour (ns=t) carry"),
        ("Then", "in-tray: holds(<part> "),
    ]
    alone = previewed(both, "https://example.org/t/once-more")
    assert (alone.text.count("Feature:"), alone.shown, alone.total) == (1, 1, 1)


def test_scenarios_that_are_not_shown_change_nothing_above() -> None:
    both = MODEL + SECOND
    assert previewed(both).text.startswith(previewed(both, most=2).text.rstrip("\n"))
