"""Names in large scopes, where an index tells which files declare them, and in small ones, which are searched."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from kit import FOLDER
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.checks.file_caches import without_cache
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names import scope
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.project import MAX_RELATED, Project, Snapshot
from robbdd_tools.names.reachability import Reachability
from robbdd_tools.workbench.model import load_all

FILES = 7
KINDS = (
    "obj set (ns=n) {name} {{ object bolt, object nut }}",
    "ws set (ns=n) {name} {{ workspace table }}",
    "similar obj set (ns=n) {name} {{ base name: {other}  count: 3 }}",
    "scene (ns=n) {name} {{ obj set <{other}> ws set <{third}> }}",
    "comp (ns=n) {name} of ws <{other}.table> {{ obj <{third}.bolt> }}",
)
COARSE = ("unknown-name", "wrong-kind", "broken-import")
"""Findings whose words depend on which files are searched first for similar names and for errors."""


def model(random: Random) -> dict[str, str]:
    """Return files that import each other at random and declare some of a few names, each as one of several kinds."""
    files: dict[str, str] = {}
    for number in range(FILES):
        imports = random.sample(range(FILES), random.randrange(4))
        lines = [f'import "f{other}.scene"' for other in imports if other != number]
        space = random.choice(("n", f"n{number}"))
        lines.append(f"ns {space} = 'https://example.org/{random.choice(('', number))}/'")
        for _ in range(random.randrange(4)):
            name, other, third = (random.choice("abcdefgh") for _ in range(3))
            line = random.choice(KINDS).format(name=name, other=other, third=third)
            lines.append(line.replace("(ns=n)", f"(ns={space})"))
        files[f"{FOLDER}f{number}.scene"] = "\n".join(lines) + "\n"
    return files


def snapshot_of(files: dict[str, str]) -> Snapshot:
    project = Project()
    for uri, text in files.items():
        project.open(uri, 1, text)
    return project.snapshot()


def findings(files: dict[str, str]) -> list[object]:
    with without_cache():
        snapshot = snapshot_of(files)
        return [comparable(entry) for uri in files for entry in fast_diagnostics(snapshot, uri)]


def comparable(entry: Diagnostic) -> object:
    return (entry.uri, entry.span, entry.code) if entry.code in COARSE else entry


@pytest.mark.parametrize("seed", range(40))
def test_a_large_scope_means_what_a_small_one_means(monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    files = model(Random(seed))
    searched = findings(files)
    monkeypatch.setattr(scope, "MAX_SEARCHED", 1)
    assert findings(files) == searched


@pytest.mark.parametrize("seed", range(40))
def test_edits_in_large_scopes_leave_the_findings_of_a_fresh_project(
    monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    monkeypatch.setattr(scope, "MAX_SEARCHED", 1)
    random, project = Random(seed), Project()
    files = model(random)
    for uri, text in files.items():
        project.open(uri, 1, text)
    for version, uri in enumerate(random.sample(list(files), 5), start=2):
        other = model(random)[uri]
        files[uri] = other if random.random() < 0.5 else files[uri] + other.partition("\nns ")[2].partition("\n")[2]
        project.open(uri, version, files[uri])
        snapshot = project.snapshot()
        edited = [comparable(entry) for each in files for entry in fast_diagnostics(snapshot, each)]
        assert edited == findings(files)


def test_the_nearest_declaration_of_a_large_scope_is_meant() -> None:
    count = scope.MAX_SEARCHED + 10
    files = {f"{FOLDER}f{n}.scene": f'import "f{(n + 1) % count}.scene"\n' for n in range(count)}
    for number in (count - 1, 5, 20):
        files[f"{FOLDER}f{number}.scene"] += "ns n = 'https://example.org/n/'\nobj set (ns=n) parts { object bolt }\n"
    large = snapshot_of(files).scope(f"{FOLDER}f3.scene")
    assert not large.is_small
    assert [file.document.uri.rpartition("/")[2] for file in large.declaring("parts")] == [
        "f5.scene",
        "f20.scene",
        f"f{count - 1}.scene",
    ]
    assert len(large.files) == count


def test_a_chain_of_imports_reaches_one_way_only() -> None:
    found = snapshot_of({f"{FOLDER}f{n}.scene": f'import "f{n + 1}.scene"\n' for n in range(4)}).reachability
    assert [found.reaches(f"{FOLDER}f1.scene", f"{FOLDER}f{n}.scene") for n in range(5)] == [False, *[True] * 4]
    assert found.unread(f"{FOLDER}f2.scene") == (f"{FOLDER}f4.scene",)


def test_checking_a_cycle_searches_each_file_a_few_times(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    count = 3 * scope.MAX_SEARCHED
    for number in range(count):
        following = (number + 1) % count
        (tmp_path / f"f{number}.scene").write_text(
            f"import \"f{following}.scene\"\nns n{number} = 'https://example.org/{number}/'\n"
            f"obj set (ns=n{number}) parts{number} {{ object bolt }}\n"
            f"scene (ns=n{number}) s{number} {{ obj set <parts{following}> }}\n",
            encoding="utf-8",
        )
    walked = 0
    walk = Reachability.walk

    def counting(self: Reachability, uri: str) -> Iterator[str]:
        nonlocal walked
        for found in walk(self, uri):
            walked += 1
            yield found

    monkeypatch.setattr(Reachability, "walk", counting)
    model = load_all([tmp_path])
    assert len(model.files) == count
    assert {finding.code for finding in model.diagnostics} >= {"cyclic-import"}
    assert walked <= 5 * count


CIRCLE_OF_COMPOSITIONS = """import "f{following}.scene"
ns n{number} = 'https://example.org/{number}/'
ws set (ns=n{number}) places{number} {{ workspace desk, workspace tray }}
comp (ns=n{number}) one{number} of ws <places{number}.desk> {{ ws comp <two{number}> }}
comp (ns=n{number}) two{number} of ws <places{following}.tray> {{ ws comp <one{number}> }}
"""


def test_files_that_import_each_other_are_validated_as_each_by_itself(tmp_path: Path) -> None:
    for number in range(3):
        text = CIRCLE_OF_COMPOSITIONS.format(number=number, following=(number + 1) % 3)
        (tmp_path / f"f{number}.scene").write_text(text, encoding="utf-8")
    together = {str(finding) for finding in load_all([tmp_path]).diagnostics}
    apart = {str(finding) for n in range(3) for finding in load_all([tmp_path / f"f{n}.scene"]).diagnostics}
    assert together == apart
    assert sum("[shacl" in words for words in together) >= 3


def test_all_sources_of_a_snapshot_are_indexed() -> None:
    snapshot = snapshot_of(model(Random(3)))
    read = [source for source in snapshot.sources.values() if isinstance(source, FileIndex)]
    assert {path for source in read for path in source.names.entries} == set(snapshot.reachability.declaring)


def circle(folder: Path, text: str, count: int) -> None:
    """Write a cycle of imports of models with ``{n}`` and ``{following}`` in their text."""
    for number in range(count):
        following = (number + 1) % count
        written = f'import "f{following}.bdd"\n' + text.format(n=number, following=following)
        (folder / f"f{number}.bdd").write_text(written, encoding="utf-8")


def test_errors_in_a_large_cycle_are_counted_at_each_import_and_the_first_are_listed(tmp_path: Path) -> None:
    count = 2 * scope.MAX_SEARCHED
    circle(tmp_path, "ns t{n} = 'https://example.org/{n}/'\nTask (ns=t{n} task-{n}\n", count)
    broken = [finding for finding in load_all([tmp_path]).diagnostics if finding.code == "broken-import"]
    assert len(broken) == count
    for finding in broken:
        assert f" has {count - 1} errors, the first: " in finding.message
        assert len(finding.related) == MAX_RELATED
        assert finding.place.uri not in {related.place.uri for related in finding.related}


def test_a_name_in_every_file_of_a_cycle_is_reported_by_a_few_searches(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    count = 2 * scope.MAX_SEARCHED
    circle(tmp_path, "ns t = 'https://example.org/t/'\nTask (ns=t) task\n", count)
    walks = 0
    walk = Reachability.walk

    def counting(self: Reachability, uri: str) -> Iterator[str]:
        nonlocal walks
        walks += 1
        return walk(self, uri)

    monkeypatch.setattr(Reachability, "walk", counting)
    found = [finding.place.uri for finding in load_all([tmp_path]).diagnostics if finding.code == "duplicate-iri"]
    assert sorted(found) == sorted(path.as_uri() for path in tmp_path.iterdir())
    assert walks <= 5 * count


def test_an_edit_in_a_large_cycle_is_compared_once_for_all_its_files(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    count = 2 * scope.MAX_SEARCHED
    circle(tmp_path, "ns t{n} = 'https://example.org/{n}/'\nTask (ns=t{n}) task-{n}\n", count)
    project, uris = Project(), [(tmp_path / f"f{number}.bdd").as_uri() for number in range(count)]
    text = (tmp_path / "f0.bdd").read_text(encoding="utf-8")
    project.open(uris[0], 1, text)
    snapshot = project.snapshot()
    before = [snapshot.file(uri) for uri in uris]
    walked = 0
    walk = Reachability.walk

    def counting(self: Reachability, uri: str) -> Iterator[str]:
        nonlocal walked
        for found in walk(self, uri):
            walked += 1
            yield found

    monkeypatch.setattr(Reachability, "walk", counting)
    project.open(uris[0], 2, text.replace("task-0", "job"))
    snapshot = project.snapshot()
    after = [snapshot.file(uri) for uri in uris]
    assert after[0] is not None
    assert "job" in after[0].definitions
    assert all(old is not new for old, new in zip(before, after, strict=True))
    assert walked <= 10 * count
    project.open(f"{FOLDER}other.bdd", 1, "")
    snapshot = project.snapshot()
    assert [snapshot.file(uri) for uri in uris] == after
