"""Text changes requested by a client, over the wire."""

from __future__ import annotations

from lsprotocol import types

from lsp_kit import CLIENTS, Editor


async def actions(editor: Editor, at: str, only: list[str] | None = None) -> dict[str, types.CodeAction]:
    place = editor.position(at)
    params = types.CodeActionParams(
        text_document=types.TextDocumentIdentifier(uri=editor.uri),
        range=types.Range(start=place, end=place),
        context=types.CodeActionContext(diagnostics=[], only=only),
    )
    found = await editor.client.text_document_code_action_async(params)
    return {action.title: action for action in found or () if isinstance(action, types.CodeAction)}


@CLIENTS
async def test_refactorings_are_offered_by_their_kind(editor: Editor) -> None:
    editor.open()
    found = await actions(editor, "variation:", ["refactor.rewrite"])
    assert list(found) == ["Write the product as a table"]
    edit = found["Write the product as a table"].edit
    assert edit is not None
    assert edit.changes is not None
    assert edit.changes[editor.uri][0].new_text.startswith("| <pick-place.thing>")
    assert await actions(editor, "variation:", ["quickfix"]) == {}


@CLIENTS
async def test_clauses_are_extracted_to_a_copy_of_a_shared_template(editor: Editor) -> None:
    start, end = editor.text.index("        Scenario part-to-bin"), editor.text.rindex("}")
    variant = editor.text[start:end]
    clause = (
        "Then: idle: holds(<pick-place.robot> can reach <pick-place.thing>, before <evt-start>)\n            variation:"
    )
    other = variant.replace("part-to-bin", "other").replace("variation:", clause)
    editor.open(editor.text[:end] + other + editor.text[end:])
    found = await actions(editor, "idle", ["refactor.extract"])
    edit = found["Extract the clauses to a new template 'pick-place-2'"].edit
    assert edit is not None
    assert edit.changes is not None
    texts = [change.new_text for change in edit.changes[editor.uri]]
    assert sum("Scenario Template (ns=crit) pick-place-2 {" in text for text in texts) == 1
    assert texts.count("pick-place-2.goal") == 1


async def test_a_literal_is_extracted_to_a_variable(editor: Editor) -> None:
    clause = "fast: holds(<robot> has config ee_speed = 0.5, before <evt-start>)"
    start = editor.text.index("Given:") + len("Given:")
    editor.open(editor.text[:start] + f" {clause} " + editor.text[start:])
    found = await actions(editor, "0.5, before", ["refactor.extract"])
    edit = found["Turn 0.5 into the variable 'ee_speed'"].edit
    assert edit is not None
    assert edit.changes is not None
    texts = [change.new_text for change in edit.changes[editor.uri]]
    assert "<ee_speed>" in texts
    assert sum("{ 0.5 }" in text for text in texts) == 1


async def test_a_scene_is_split_off_into_a_new_file(editor: Editor) -> None:
    editor.open()
    editor.path = editor.path.with_name("bench.scene")
    editor.uri = editor.path.as_uri()
    editor.open(editor.path.read_text(encoding="utf-8"))
    found = await actions(editor, "scene (ns=env)", ["refactor.extract"])
    edit = found["Move the scene to 'bench_scene.scene'"].edit
    assert edit is not None
    changes = list(edit.document_changes or ())
    assert isinstance(changes[0], types.CreateFile)
    assert len(changes) == 5


async def test_the_file_of_an_import_is_made_where_the_client_makes_files(editor: Editor) -> None:
    editor.open(editor.text.replace('import "bench.scene"', 'import "cell.scene"'))
    found = await actions(editor, "cell.scene", ["quickfix"])
    edit = found["Create 'cell.scene'"].edit
    assert edit is not None
    made = next(iter(edit.document_changes or ()))
    assert isinstance(made, types.CreateFile)
    assert made.uri == editor.path.with_name("cell.scene").as_uri()


@CLIENTS
async def test_imports_follow_a_renamed_file(editor: Editor) -> None:
    old = editor.path.with_name("bench.scene").as_uri()
    move = types.FileRename(old_uri=old, new_uri=old.replace("bench.scene", "cells/bench.scene"))
    edit = await editor.client.workspace_will_rename_files_async(types.RenameFilesParams(files=[move]))
    assert edit is not None
    assert edit.changes is not None
    new = {uri.rsplit("/", 1)[-1]: [change.new_text for change in edits] for uri, edits in edit.changes.items()}
    assert new == {"pickplace.bdd": ["cells/bench.scene"], "bench.scenex": ["cells/bench.scene"]}


@CLIENTS
async def test_parts_are_laid_out_and_names_linked(editor: Editor) -> None:
    tidy = editor.text
    editor.open(tidy.replace("    var thing", "  var   thing"))
    document = types.TextDocumentIdentifier(uri=editor.uri)
    options = types.FormattingOptions(tab_size=4, insert_spaces=True)
    place = editor.position("var   thing")
    edits = await editor.client.text_document_range_formatting_async(
        types.DocumentRangeFormattingParams(
            text_document=document, range=types.Range(start=place, end=place), options=options
        )
    )
    assert [edit.new_text for edit in edits or ()] == ["    var thing"]
    typed = await editor.client.text_document_on_type_formatting_async(
        types.DocumentOnTypeFormattingParams(text_document=document, position=place, ch="}", options=options)
    )
    assert [edit.new_text for edit in typed or ()] == ["    var thing"]
    linked = await editor.client.text_document_linked_editing_range_async(
        types.LinkedEditingRangeParams(**editor.at("var rob", after=True))
    )
    assert linked is not None
    assert len(linked.ranges) == 5
    # The executions in the other file observe this one: typing here would not change them.
    observed = types.LinkedEditingRangeParams(**editor.at("var   thi", after=True))
    assert await editor.client.text_document_linked_editing_range_async(observed) is None
