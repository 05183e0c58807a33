"""Completion after every token of every model: proposals parse where they are offered, and no accepted word is missing.

A model is cut at each boundary of two tokens, as while it is being typed.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from kit import MODELS, SCENE
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.completion import complete
from robbdd_tools.features.cursor import cursor_at
from robbdd_tools.features.expected_words import place_after
from robbdd_tools.features.name_completion import Completion
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.grammar_files import grammar_text
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.parsed import Parsed
from robbdd_tools.syntax.split import split

SAMPLE = 61
"""One of this many boundaries is tried in each run of the tests; a prime, so that no construct is always left out."""
TOKEN = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|[\w\-.]+|\S")
UNKNOWN = "zzunknown"
"""A word that is no keyword: it is accepted where any name is."""

OWN: dict[str, str] = {
    "own.bdd": """import "lab.scene"
ns t = 'https://example.org/t/'
Task (ns=t) weld
Event (ns=t) go
Event (ns=t) grip
Event (ns=t) stop
const set (ns=t) speeds { 0.2 m/s, 0.15 m/s }
Behaviour Tree (ns=t) plan { sequence first { node pick selector either { node left node right } } }
Scenario Template (ns=t) welding {
    duration: from <go> until <stop>
    task: <weld>
    var part
    var tool
    set var seams
    var limit
    event close when <part> is nearer than 3 cm to <tool> and <tool> moves slower than <limit> for 0.5 seconds
    event lifted when <part> is held by <tool>
    Given:
        ready: holds(<part> is at rest, before the first <grip>)
        ( not cold: holds(<part> is held by <tool>, within 2 seconds before <grip>) )
    for all (var seam in <seams>) {
        When:
            event <go> occurs
            Behaviour (ns=t) reach { duration: from <grip> until <stop> <tool> picks <part> emits pick-end as <grip> }
        Then:
            ( a: holds(<part> is nearer than 3 cm to <seam>, after <grip>)
              or ( b: holds(<tool> moves slower than <limit>, at some time from <go> until <stop>)
                   and holds(<tool> does not drop <part> whenever <part> is held by <tool>
                   and <part> is at rest, from <go> until <stop>) ) )
            (var y exists in <seams>) such that { "the seam is clean" after every <stop> }
            text: holds(pred("{a} shines", a=<part>, b="red", c=0.5 m), 0.5 seconds after the last <stop>)
    }
    Then:
        still: holds(<part> is at rest, after <stop>)
    When:
        Behaviour (ns=t) lift { duration: from <grip> until <stop> <tool> picks <part> }
        meanwhile Behaviour (ns=t) hold { duration: from <go> until <stop> <tool> picks <part> }
    Given: calm: holds(<part> is at rest, before <grip>)
    for all (var seam in <seams>) {
        When: Behaviour (ns=t) back { duration: from <grip> until <stop> <tool> picks <part> }
    }
}
User Story (ns=t) welds {
    As A "welder" I Want "seams" So That "parts hold"
    Scenarios:
        Scenario by-hand {
            template: <welding>
            scene: <bench_scene>
            Given: quiet: holds(<welding.part> is at rest, before <go>)
            variation:
                var <welding.part>: obj set <parts>
                var <welding.tool>: { <arms.panda> }
                set var <welding.seams>: select 1 combinations from <places>
                var <welding.limit>: set <speeds>
        }
        Scenario Variant by-table {
            template: <welding>
            scene: <bench_scene>
            variation:
                | <welding.part> | <welding.tool> | <welding.seams> | <welding.limit> |
                |---|---|---|---|
                | <parts.nut> | <arms.ur10> | { <places.tray_ws> } | 0.3 m/s |
        }
}
""",
    "lab.scene": SCENE,
}
"""A model that has constructs of the language which the examples lack."""


def words(language: str) -> frozenset[str]:
    """All keywords of a kind of file."""
    return frozenset(re.findall(r"'([^\W\d][\w\-]*)'", grammar_text(language)))


def own_model(folder: Path) -> list[Path]:
    for name, text in OWN.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in OWN]


def boundaries(text: str) -> list[int]:
    """The ends of all tokens but comments."""
    return [match.end() for match in TOKEN.finditer(text) if not match[0].startswith("//")]


def plain(entry: Completion) -> str:
    if entry.kind != "snippet":
        return entry.text
    return re.sub(r"\$\{\d+(?::([^}]*)|\|([^,|]*)[^}]*)\}", lambda match: match[1] or match[2] or "", entry.text)


def applied(before: str, end: int, entry: Completion) -> str:
    """The text before a cursor at ``end`` after a proposal was chosen."""
    opening = sorted(end - edit.span.start for edit in entry.edits if edit.text == "(")
    for distance in opening:
        before = f"{before[: len(before) - distance]}({before[len(before) - distance :]}"
    return before + plain(entry)


def is_accepted(language: str, text: str) -> bool:
    """Whether the parser gets to the end of a text."""
    for _ in range(len(text)):
        parsed = parse_chunk(language, text)
        if not isinstance(parsed, Parsed):
            return not text[parsed.offset :].strip()
        if parsed.trailing is None:
            return True
        text = text[parsed.trailing :]
    return True


def faults_after(path: Path, end: int) -> Iterator[str]:
    """Yield what is wrong with the proposals after the first ``end`` characters of a model."""
    language, uri = path.suffix[1:], path_to_uri(path)
    text = path.read_text(encoding="utf-8")[:end] + " "
    project = Project()
    project.load(uri)
    project.open(uri, 2, text)
    snapshot = project.snapshot()
    entries = complete(snapshot, uri, len(text))
    file = snapshot.file(uri)
    assert file is not None
    before = cursor_at(file, len(text)).before
    for entry in entries:
        if not is_accepted(language, applied(before, len(text), entry) + " "):
            yield f"'{entry.text}' does not parse after '…{before[-60:]}'"
    if not is_accepted(language, before):
        return
    offered = {plain(entry).split()[0] for entry in entries if entry.text}
    if is_accepted(language, f"{before}{UNKNOWN} "):
        # Any word is accepted as a name; the parser says which ones are keywords there.
        expected = place_after(language, before).expected
        for word in words(language) & (frozenset() if expected is None else expected.literals):
            if word not in {re.split(r"[^\w\-]", one)[0] for one in offered}:
                yield f"'{word}' is missing beside a name after '…{before[-60:]}'"
        return
    for word in words(language):
        if word not in offered and is_accepted(language, f"{before}{word} "):
            yield f"'{word}' is missing after '…{before[-60:]}'"


@pytest.mark.parametrize("path", MODELS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_sample_of_the_prefixes_of_each_example(path: Path) -> None:
    ends = boundaries(path.read_text(encoding="utf-8"))
    chosen = ends[hash_of(path) % SAMPLE :: SAMPLE][:40]
    assert [fault for end in chosen for fault in faults_after(path, end)] == []


@pytest.mark.parametrize("name", list(OWN))
def test_a_sample_of_the_prefixes_of_a_model_with_rare_constructs(name: str, tmp_path: Path) -> None:
    own_model(tmp_path)
    path = tmp_path / name
    language = path.suffix[1:]
    declarations = [parse_declaration(language, chunk.text) for chunk in split(language, OWN[name])]
    assert [fault.message for declaration in declarations for fault in declaration.faults] == []
    assert [fault for end in boundaries(OWN[name])[::7] for fault in faults_after(path, end)] == []


@pytest.mark.nightly
@pytest.mark.parametrize("name", list(OWN))
def test_each_prefix_of_a_model_with_rare_constructs(name: str, tmp_path: Path) -> None:
    own_model(tmp_path)
    path = tmp_path / name
    assert [fault for end in boundaries(OWN[name]) for fault in faults_after(path, end)] == []


@pytest.mark.nightly
@pytest.mark.parametrize("path", MODELS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_each_prefix_of_each_example(path: Path) -> None:
    ends = boundaries(path.read_text(encoding="utf-8"))
    assert [fault for end in ends for fault in faults_after(path, end)] == []


def hash_of(path: Path) -> int:
    """A number of a path that is the same in each run."""
    return sum(map(ord, f"{path.parent.name}/{path.name}"))
