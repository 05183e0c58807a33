"""In broken text, outline, hover and definition go on working: everywhere else, and around the mistake."""

from __future__ import annotations

import re
from itertools import chain

from kit import MODEL, Fixture, fixture
from robbdd_tools.features.definition import definition
from robbdd_tools.features.hover import hover
from robbdd_tools.features.outline import Item, outline

WORDS = re.compile(r"[\w\-.]+|[^\w\s]")
REFERENCES = re.compile(r"<([\w\-.]+)>")
BLOCK = re.compile(r"^(?:Event|Task) .*\n|^(?:Scenario|User) (?:.*\n)*?\}\n", re.MULTILINE)
BLOCKS = [found.span() for found in BLOCK.finditer(MODEL)]
"""The declarations of the model behind its import and namespace."""
CUTS = [(block, found.span()) for block in BLOCKS for found in WORDS.finditer(MODEL, *block)]
"""Each word and sign of a declaration, to be left out."""


def without(cut: tuple[int, int]) -> Fixture:
    return fixture(MODEL[: cut[0]] + MODEL[cut[1] :])


def targets(case: Fixture, cut: tuple[int, int] = (0, 0)) -> dict[int, tuple[str, int] | None]:
    """The file and place (in the sound text) that each reference outside of a cut leads to, by its own place."""
    shift = cut[1] - cut[0]
    found: dict[int, tuple[str, int] | None] = {}
    for match in REFERENCES.finditer(MODEL):
        if match.end() <= cut[0] or cut[1] <= match.start():
            place = match.start(1) - (shift if cut[1] <= match.start() else 0)
            target = definition(case.snapshot, case.uri, place)
            explained = hover(case.snapshot, case.uri, place)
            assert target is None or (explained is not None and explained.span.contains(place))
            moved = shift if target and target[0] == case.uri and target[1].start >= cut[0] else 0
            found[match.start()] = target and (target[0], target[1].start + moved)
    return found


SOUND = targets(fixture(MODEL))


def items(case: Fixture, block: tuple[int, int], shift: int = 0) -> list[Item]:
    """The outline outside of a block, which has lost some letters."""
    inside = range(block[0], block[1] - shift)
    return [item for item in outline(case.snapshot, case.uri) if item.span.start not in inside]


def names(found: list[Item]) -> list[tuple[str, str]]:
    own = [[(item.name, str(item.kind)), *names(list(item.children))] for item in found]
    return list(chain.from_iterable(own))


def test_a_word_that_is_missing_harms_no_other_declaration() -> None:
    assert None not in SOUND.values()
    for block, cut in CUTS:
        case = without(cut)
        assert names(items(case, block, cut[1] - cut[0])) == names(items(fixture(MODEL), block)), cut
        found = targets(case, cut)
        for place, target in found.items():
            expected = SOUND[place]
            assert expected is not None
            is_of_block = expected[0] == case.uri and block[0] <= expected[1] < block[1]
            if not block[0] <= place < block[1] and not is_of_block:
                assert target == expected, (cut, MODEL[place : place + 20])


def test_names_of_a_broken_declaration_are_nearly_all_known_inside_it_and_to_others() -> None:
    inside: list[bool] = []
    outside: list[bool] = []
    for block, cut in CUTS:
        for place, target in targets(without(cut), cut).items():
            (inside if block[0] <= place < block[1] else outside).append(target == SOUND[place])
    # What is left: names whose own word or opening keyword is missing.
    assert sum(inside) >= 0.97 * len(inside)
    assert sum(outside) >= 0.97 * len(outside)


def test_half_a_scenario_leads_to_what_it_names() -> None:
    text = MODEL[: MODEL.index("            variation:")] + "            variation:\n var <fetch.part"
    case = fixture(text)
    for name in ("fetch>", "bench_scene>", "fetch.part"):
        sound = SOUND[MODEL.rindex(f"<{name}", 0, MODEL.index("obj set <parts>"))]
        found = definition(case.snapshot, case.uri, text.rindex(f"<{name}") + 1)
        assert found is not None
        assert (found[0], found[1].start) == sound
    assert ("fetching", "user story") in names(outline(case.snapshot, case.uri))
