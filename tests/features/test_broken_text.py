"""In broken text of every file kind, the features go on working: everywhere else, and around the mistake."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import pytest

from kit import FOLDER, MODEL, SCENE
from names.test_kinds import ARM, CELL, RUN, VARIANT
from robbdd_tools.base.document import Span
from robbdd_tools.features.completion import complete
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.folding import folds
from robbdd_tools.features.goto_definition import definition
from robbdd_tools.features.hover import hover
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.features.outline import Item, outline
from robbdd_tools.features.selection_ranges import selections
from robbdd_tools.features.semantic_tokens import Token, semantic_tokens
from robbdd_tools.names.project import Project, Snapshot
from syntax.test_scenex import TREE

WORDS = re.compile(r"[\w\-.]+|[^\w\s]")
REFERENCES = re.compile(r"<([\w\-.]+)>")
GRIPPER = "ns x = 'https://example.org/x/'\nktree (ns=x) gripper { body palm { frame origin { } } joints { } }\n"
CODE = re.compile(r"//[^\n]*|\"[^\"\n]*\"|'[^'\n]*'|(?P<word>[^\W\d][\w\-.^*/]*)|\d[\w.\-]*")
FILES = {
    "main.bdd": VARIANT,
    "lab.scene": SCENE,
    "arm.ktree": f"{ARM}{GRIPPER}{TREE}\n",
    "cell.scenex": CELL,
    "run.bddx": RUN,
}
"""One sound model of each kind; together they are a project."""

Place = tuple[int, int]
Targets = dict[int, tuple[str, int] | None]


@dataclass(frozen=True)
class Model:
    """One of the files, in which texts are replaced while the others stay unchanged."""

    name: str
    step: int
    """Only each so many-th word is left out."""

    @property
    def uri(self) -> str:
        return FOLDER + self.name

    @property
    def text(self) -> str:
        return FILES[self.name]

    @cached_property
    def project(self) -> Project:
        project = Project()
        for name, text in FILES.items():
            project.open(FOLDER + name, 1, text)
        return project

    @cached_property
    def blocks(self) -> list[Place]:
        """The declarations after the imports and namespaces."""
        file = self.with_text(self.text).file(self.uri)
        assert file is not None
        placed = [one for one in file.declarations if not re.match(r"import|ns\b", one.declaration.text)]
        return [(one.span.start, one.span.start + len(one.declaration.text.rstrip())) for one in placed]

    @cached_property
    def cuts(self) -> list[tuple[Place, Place]]:
        """The words and signs of declarations that are left out."""
        found = [(block, word.span()) for block in self.blocks for word in WORDS.finditer(self.text, *block)]
        return found[:: self.step]

    @cached_property
    def sound(self) -> Targets:
        return self.targets()

    @cached_property
    def needed(self) -> dict[int, list[int]]:
        """The places in the file that each reference leads to by some part of its qualified name."""
        snapshot, found = self.with_text(self.text), dict[int, list[int]]()
        for match in REFERENCES.finditer(self.text):
            parts = [part.start() for part in re.finditer(r"[\w\-]+", match[1])]
            targets = [definition(snapshot, self.uri, match.start(1) + part) for part in parts]
            found[match.start()] = [target[1].start for target in targets if target and target[0] == self.uri]
        return found

    def with_text(self, text: str) -> Snapshot:
        self.project.open(self.uri, 1, text)
        return self.project.snapshot()

    def without(self, cut: Place) -> Snapshot:
        return self.with_text(self.text[: cut[0]] + self.text[cut[1] :])

    def targets(self, cut: Place = (0, 0)) -> Targets:
        """The file and place (in the sound text) that each reference outside of a cut leads to, by its own place."""
        snapshot, shift = self.without(cut), cut[1] - cut[0]
        found: Targets = {}
        for match in REFERENCES.finditer(self.text):
            if match.end() <= cut[0] or cut[1] <= match.start():
                # The last part of a qualified name refers to its target.
                last = match.end() - 2
                place = last - (shift if cut[1] <= match.start() else 0)
                target = definition(snapshot, self.uri, place)
                explained = hover(snapshot, self.uri, place)
                assert target is None or (explained is not None and explained.span.contains(place))
                moved = shift if target and target[0] == self.uri and target[1].start >= cut[0] else 0
                found[match.start()] = target and (target[0], target[1].start + moved)
        return found


SHORT = 1_000
"""Of shorter texts, each word is left out."""
SAMPLES = [pytest.param(Model(name, 1 if len(text) < SHORT else 3), id=name) for name, text in FILES.items()]
WHOLE = [pytest.param(Model(name, 1), id=f"{name}-whole", marks=pytest.mark.nightly) for name in FILES]
EACH = pytest.mark.parametrize("model", [*SAMPLES, *WHOLE])


def names(found: list[Item]) -> list[tuple[str, str]]:
    own = [[(item.name, str(item.kind)), *names(list(item.children))] for item in found]
    return list(chain.from_iterable(own))


def outside(model: Model, snapshot: Snapshot, block: Place, shift: int = 0) -> list[tuple[str, str]]:
    """The outline outside of a block, which has lost some letters."""
    inside = range(block[0], block[1] - shift)
    return names([item for item in outline(snapshot, model.uri) if item.span.start not in inside])


@EACH
def test_a_word_that_is_missing_harms_no_other_declaration(model: Model) -> None:
    assert None not in model.sound.values()
    sound = {block: outside(model, model.with_text(model.text), block) for block in model.blocks}
    for block, cut in model.cuts:
        assert outside(model, model.without(cut), block, cut[1] - cut[0]) == sound[block], cut
        for place, target in model.targets(cut).items():
            needs_block = any(block[0] <= needed < block[1] for needed in model.needed[place])
            if not block[0] <= place < block[1] and not needs_block:
                assert target == model.sound[place], (cut, model.text[place : place + 20])


@EACH
def test_names_of_a_broken_declaration_are_nearly_all_known_inside_it_and_to_others(model: Model) -> None:
    inside: list[bool] = []
    elsewhere: list[bool] = []
    for block, cut in model.cuts:
        for place, target in model.targets(cut).items():
            (inside if block[0] <= place < block[1] else elsewhere).append(target == model.sound[place])
    # What is left: names whose own word or opening keyword is missing.
    assert sum(inside) >= 0.97 * len(inside)
    assert sum(elsewhere) >= 0.97 * len(elsewhere)


@EACH
def test_text_that_ends_half_way_keeps_all_that_stands_whole_above(model: Model) -> None:
    whole = model.with_text(model.text)
    items, folded, coloured = outline(whole, model.uri), folds(whole, model.uri), semantic_tokens(whole, model.uri)
    for block, (end, _) in model.cuts:
        snapshot, start = model.with_text(model.text[:end]), block[0]
        above = [item for item in outline(snapshot, model.uri) if item.span.start < start]
        assert above == [item for item in items if item.span.start < start]
        line = model.text.count("\n", 0, start)
        found = [fold for fold in folds(snapshot, model.uri) if fold.last < line]
        assert found == [fold for fold in folded if fold.last < line]
        below = {place for place, needed in model.needed.items() if any(one >= start for one in needed)}
        colours = tokens_above(semantic_tokens(snapshot, model.uri), start, below, model.text)
        assert colours == tokens_above(coloured, start, below, model.text)
        assert all(item.extent.end <= end for item in outline(snapshot, model.uri))
        assert not end or selections(snapshot, model.uri, end)[-1] == Span(0, end)


def tokens_above(tokens: list[Token], end: int, below: set[int], text: str) -> list[Token]:
    """The tokens that end before a place, without references to later declarations."""
    whole = [token for token in tokens if token.span.end <= end]
    return [token for token in whole if text.rfind("<", 0, token.span.start) not in below]


@EACH
def test_whatever_stands_next_is_offered_where_a_text_ends_and_where_the_word_is_begun(model: Model) -> None:
    file = model.with_text(model.text).file(model.uri)
    assert file is not None
    declared = {found.span.start for found in file.definitions.values()}
    words = [found for found in CODE.finditer(model.text) if found["word"] and found.start() not in declared]
    for start, end in (found.span() for found in words):
        reference = start - 1 if model.text[start - 1] == "<" else None
        if reference is not None and any(needed >= start for needed in model.needed[reference]):
            continue
        for typed in (0, 1):
            snapshot = model.with_text(model.text[: start + typed])
            found = [one for one in complete(snapshot, model.uri, start + typed) if one.kind != "snippet"]
            if reference is None:
                assert model.text[start:end] in " ".join(one.label for one in found).split(), model.text[:end]
            else:
                assert model.sound[reference] in [declaration(snapshot, one) for one in found], model.text[:end]
            assert {one.span for one in found} == {Span(start, start + typed)}


def declaration(snapshot: Snapshot, offered: Completion) -> tuple[str, int] | None:
    """The file and the place of the declaration of an offered name."""
    file = snapshot.file(offered.origin[0]) if offered.origin else None
    return (
        None
        if file is None or offered.origin is None
        else (offered.origin[0], file.definitions[offered.origin[1]].span.start)
    )


def test_a_text_that_ends_early_has_each_message_once_at_its_place() -> None:
    end = MODEL.index("<places.tray_ws")
    for cut in range(end - 40, end + 16):
        project = Project()
        project.open(FOLDER + "lab.scene", 1, SCENE)
        project.open(FOLDER + "main.bdd", 1, MODEL[:cut])
        found = fast_diagnostics(project.snapshot(), FOLDER + "main.bdd")
        shown = [(one.span, one.code, one.message) for one in found]
        assert len(set(shown)) == len(shown) > 0, MODEL[:cut][-30:]
