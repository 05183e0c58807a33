"""Stories and variants as a tree of tests shows them."""

from __future__ import annotations

from pathlib import Path

from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE, fixture
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.stories import stories_in, story_files
from robbdd_tools.names.project import Project


def told(text: str) -> list[str]:
    made = fixture(text)
    lines: list[str] = []
    for story in stories_in(made.snapshot, made.uri):
        lines.append(f"{story.iri}: {story.wants}")
        source = made.snapshot.file(made.uri)
        assert source is not None
        for variant in story.variants:
            values = source.document.text[variant.variation.start : variant.variation.end].split("\n")[0]
            lines.append(f"  {variant.placed.iri} {variant.count} | {values}")
    return lines


def test_a_story_is_told_with_its_variants_and_how_many_scenarios_they_make() -> None:
    assert told(MODEL) == [
        "https://example.org/t/fetching: parts fetched",
        "  https://example.org/t/bench-to-tray 4 | var <fetch.part>: obj set <parts>",
    ]


def test_two_stories_keep_their_variants_apart() -> None:
    other = STORY.replace("fetching", "again").replace("bench-to-tray", "tray-to-bench")
    assert [line.split()[0] for line in told(MODEL + other)] == [
        "https://example.org/t/fetching:",
        "https://example.org/t/bench-to-tray",
        "https://example.org/t/again:",
        "https://example.org/t/tray-to-bench",
    ]


def test_a_mistake_in_a_set_leaves_the_number_open() -> None:
    (_, variant) = told(MODEL.replace("obj set <parts>\n                var <fetch.robot>", "obj set <part>\n var <x>"))
    assert " None |" in variant


def test_files_with_stories_are_found_on_disk_and_in_the_editor(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "events.bdd").write_text(EVENTS + TEMPLATE, encoding="utf-8")
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "told.bdd").write_text(STORY, encoding="utf-8")
    (tmp_path / "cleared.bdd").write_text(STORY, encoding="utf-8")
    project = Project()
    project.open(path_to_uri(tmp_path / "cleared.bdd"), 1, "")
    project.open(path_to_uri(tmp_path / "fresh.bdd"), 1, STORY)
    found = story_files(project.snapshot(), [path_to_uri(tmp_path)])
    assert [uri.rsplit("/", 1)[-1] for uri in found] == ["fresh.bdd", "told.bdd"]
