"""Unopened files that import open ones: they are found, renamed and counted as users."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from lsp_kit import CLIENTS, PATIENCE, Editor
from robbdd_tools.base.files import path_to_uri, uri_to_path

ELEMENT_USER = """ns acc = 'https://example.org/acc/'
const set (ns=acc) picked { <places.right_ws> }
"""
EVENT_USER = """import "pickplace.bdd"
ns later = 'https://example.org/later/'
Task (ns=later) wait-task
Scenario Template (ns=later) wait {
    duration: from <EVENT> until <EVENT>
    task: <wait-task>
    var thing
    var robot
    var place
    When:
        Behaviour (ns=later) move {
            duration: from <EVENT> until <EVENT>
            <robot> picks <thing> and places at <place>
        }
    Then:
        there: holds(<thing> is located at <place>, after <EVENT>)
}
"""


@pytest.fixture
def scene(editor: Editor) -> Editor:
    """The scene, whose users stay closed."""
    return opened(editor, "bench.scene")


def opened(editor: Editor, name: str) -> Editor:
    other = Editor(editor.client, editor.path.parent.parent)
    other.path = editor.path.with_name(name)
    other.uri = path_to_uri(other.path)
    other.open(other.path.read_text(encoding="utf-8"))
    return other


async def users(editor: Editor, at: str) -> set[str]:
    """The names of the files with references to a name."""
    context = types.ReferenceContext(include_declaration=False)
    params = types.ReferenceParams(context=context, **editor.at(at, after=True))
    found = await editor.client.text_document_references_async(params)
    return {location.uri.rsplit("/", 1)[-1] for location in found or ()}


async def hovered(editor: Editor, at: str) -> str:
    """What a hover says."""
    found = await editor.client.text_document_hover_async(types.HoverParams(**editor.at(at, after=True)))
    assert found is not None
    return str(found.contents)


def write(edit: types.WorkspaceEdit | None) -> set[str]:
    """Write the edits into the files on disk."""
    assert edit is not None
    assert edit.changes is not None
    for uri, edits in edit.changes.items():
        path = uri_to_path(uri)
        assert path is not None
        lines = path.read_text(encoding="utf-8").split("\n")
        for one in sorted(edits, key=lambda one: (one.range.start.line, one.range.start.character), reverse=True):
            assert one.range.start.line == one.range.end.line
            line = lines[one.range.start.line]
            lines[one.range.start.line] = (
                line[: one.range.start.character] + one.new_text + line[one.range.end.character :]
            )
        path.write_text("\n".join(lines), encoding="utf-8")
    return {uri.rsplit("/", 1)[-1] for uri in edit.changes}


async def rename(editor: Editor, at: str, name: str) -> set[str]:
    params = types.RenameParams(new_name=name, **editor.at(at, after=True))
    return write(await editor.client.text_document_rename_async(params))


@CLIENTS
async def test_a_renamed_element_is_renamed_in_files_that_are_closed(scene: Editor) -> None:
    assert await rename(scene, "workspace left", "sink_ws") == {"bench.scene", "pickplace.bdd"}
    scene.text = scene.text.replace("left_ws", "sink_ws")
    assert await rename(scene, "object bin_left", "sink") == {"bench.scene", "bench.scenex"}
    folder = scene.path.parent
    texts = [path.read_text(encoding="utf-8") for path in folder.iterdir() if path.is_file()]
    assert not any("<furniture.bin_left>" in text or "<places.left_ws>" in text for text in texts)


@pytest.mark.parametrize(
    ("at", "users"),
    [
        ("var thing", {"pickplace.bdd", "pickplace.bddx"}),
        ("at-goal", {"pickplace.bdd", "pickplace.bddx"}),
        ("Scenario part-to-bin", {"pickplace.bdd", "pickplace.bddx"}),
        ("(ns=crit) evt-place-end", {"pickplace.bdd", "later.bdd"}),
    ],
)
async def test_variables_clauses_scenarios_and_events_are_renamed_in_closed_files(
    editor: Editor, at: str, users: set[str]
) -> None:
    later = EVENT_USER.replace("EVENT", "evt-place-end")
    editor.path.with_name("later.bdd").write_text(later, encoding="utf-8")
    editor.open()
    assert await rename(editor, at, "renamed") == users


async def test_a_refactoring_right_after_opening_knows_the_closed_files_that_it_concerns(scene: Editor) -> None:
    place = scene.position("scene (ns=env)")
    params = types.CodeActionParams(
        text_document=types.TextDocumentIdentifier(uri=scene.uri),
        range=types.Range(start=place, end=place),
        context=types.CodeActionContext(diagnostics=[], only=["refactor.extract"]),
    )
    (action,) = list(await scene.client.text_document_code_action_async(params) or ())
    assert isinstance(action, types.CodeAction)
    assert action.edit is not None
    edits = [change for change in action.edit.document_changes or () if isinstance(change, types.TextDocumentEdit)]
    changed = {edit.text_document.uri.rsplit("/", 1)[-1] for edit in edits}
    assert changed == {"bench_scene.scene", "bench.scene", "pickplace.bdd", "bench.scenex"}


async def test_names_linked_right_after_opening_are_not_used_in_closed_files(editor: Editor) -> None:
    # So many that reading them all takes longer than the request does.
    for number in range(300):
        text = (
            f'import "bench.scene"\nns x = "https://example.org/{number}/"\nobj set (ns=x) set{number} {{ object a }}\n'
        )
        editor.path.with_name(f"other{number}.scene").write_text(text, encoding="utf-8")
    scene = opened(editor, "bench.scene")
    params = types.LinkedEditingRangeParams(**scene.at("object bin_ri", after=True))
    assert await scene.client.text_document_linked_editing_range_async(params) is None


async def test_hover_tells_of_uses_in_closed_files(scene: Editor) -> None:
    async with asyncio.timeout(PATIENCE):
        while "so far" in (told := await hovered(scene, "object bin_ri")):
            pass
    assert "used 2 times: bench.scene:13, bench.scenex:13" in told


async def test_what_carries_out_a_clause_is_found_in_closed_files(editor: Editor) -> None:
    editor.open()
    where = types.ImplementationParams(**editor.at("at-goal", after=True))
    found = await editor.client.text_document_implementation_async(where)
    assert isinstance(found, list | tuple)
    places = [place.uri.rsplit("/", 1)[-1] for place in found if isinstance(place, types.Location)]
    assert places == ["pickplace.bddx"]


@CLIENTS
async def test_symbols_of_closed_files_are_listed(client: LanguageClient, editor: Editor) -> None:
    params = types.WorkspaceSymbolParams(query="near-goal")
    found = await client.workspace_symbol_async(params)
    policy = editor.path.with_suffix(".bddx")
    lines = policy.read_text(encoding="utf-8").splitlines()
    (symbol,) = list(found or [])
    assert isinstance(symbol.location, types.Location)
    assert (symbol.name, symbol.location.uri) == ("near-goal", path_to_uri(policy))
    assert "near-goal" in lines[symbol.location.range.start.line]


async def test_callers_are_found_in_closed_files(editor: Editor) -> None:
    library, story = editor.text[: editor.text.index("User Story")], editor.text[editor.text.index("User Story") :]
    namespaces = "".join(line for line in library.splitlines(keepends=True) if line.startswith("ns "))
    editor.path.write_text(library, encoding="utf-8")
    user = editor.path.with_name("user.bdd")
    user.write_text(f'import "pickplace.bdd"\n{namespaces}{story}', encoding="utf-8")
    editor.open(library)
    where = types.CallHierarchyPrepareParams(**editor.at("Scenario Template (ns=crit) pick", after=True))
    items = await editor.client.text_document_prepare_call_hierarchy_async(where)
    assert items
    incoming = types.CallHierarchyIncomingCallsParams(item=items[0])
    calls = await editor.client.call_hierarchy_incoming_calls_async(incoming)
    assert [(call.from_.name, call.from_.uri) for call in calls or ()] == [("part-to-bin", path_to_uri(user))]


async def test_what_a_closed_file_uses_is_not_called_unused_until_it_uses_it_no_more(editor: Editor) -> None:
    editor.path.with_name("pickplace.bddx").unlink()
    later = editor.path.with_name("later.bdd")
    later.write_text(EVENT_USER.replace("EVENT", "evt-idle"), encoding="utf-8")
    editor.open(editor.text.replace("Event (ns=crit)", "Event (ns=crit) evt-idle\nEvent (ns=crit)", 1))
    await users(editor, "evt-idle")
    await editor.diagnostics()
    later.unlink()
    tell(editor.client, later, types.FileChangeType.Deleted)
    await editor.diagnostics("unused-event")
    later.write_text(EVENT_USER.replace("EVENT", "evt-idle"), encoding="utf-8")
    tell(editor.client, later, types.FileChangeType.Created)
    await editor.diagnostics()


async def test_a_search_that_finds_a_new_file_changes_the_diagnostics(editor: Editor) -> None:
    editor.path.with_name("pickplace.bddx").unlink()
    editor.open(editor.text.replace("Event (ns=crit)", "Event (ns=crit) evt-idle\nEvent (ns=crit)", 1))
    await editor.diagnostics("unused-event")
    editor.path.with_name("later.bdd").write_text(EVENT_USER.replace("EVENT", "evt-idle"), encoding="utf-8")
    async with asyncio.timeout(PATIENCE):
        while "later.bdd" not in await users(editor, "evt-idle"):
            await asyncio.sleep(0.1)
    await editor.diagnostics()


async def test_the_workspace_ends_where_its_folders_end(
    scene: Editor, tmp_path_factory: pytest.TempPathFactory
) -> None:
    outside = tmp_path_factory.mktemp("outside") / "user.bdd"
    outside.write_text(f'import "{scene.path}"\n{ELEMENT_USER}', encoding="utf-8")
    assert "user.bdd" not in await users(scene, "workspace right_ws")


async def test_around_a_file_outside_of_the_workspace_its_own_folder_counts(
    editor: Editor, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("loose") / "pickplace"
    (folder / "deep").mkdir(parents=True)
    scene = editor.path.with_name("bench.scene").read_text(encoding="utf-8")
    (folder / "bench.scene").write_text(scene, encoding="utf-8")
    (folder / "deep" / "user.bdd").write_text(f'import "../bench.scene"\n{ELEMENT_USER}', encoding="utf-8")
    loose = Editor(editor.client, editor.path.parent.parent)
    loose.uri = path_to_uri(folder / "bench.scene")
    loose.open(scene)
    assert await users(loose, "workspace right_ws") == {"bench.scene", "user.bdd"}


def tell(client: LanguageClient, path: Path, kind: types.FileChangeType) -> None:
    change = types.FileEvent(uri=path_to_uri(path), type=kind)
    client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[change]))
