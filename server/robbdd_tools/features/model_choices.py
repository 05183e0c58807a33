"""Quick fixes of ``no-model``: add an entry to a ``.scenex`` that assigns a catalog model to an element of a scene."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, NewFile
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import file_state
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.no_model import Gap, gaps_of, scene_instances
from robbdd_tools.names.elements import Site
from robbdd_tools.names.imports import import_path
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

_WORDS = {"object": "obj", "agent": "agn"}


def model_choices(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield a fix for each catalog model. The fix adds the entry that assigns the model to the reported elements."""
    for placed in file.declarations:
        for gap in gaps_of(Site(snapshot, file, placed)):
            if gap.span == diagnostic.span:
                for kind in sorted({element.kind for element in gap.elements}):
                    yield from _choices(gap, kind)


def _choices(gap: Gap, kind: str) -> Iterator[Fix]:
    catalog = load_catalog()
    names = ", ".join(element.name.rpartition(".")[2] for element in gap.elements if element.kind == kind)
    for model in catalog.objects if kind == "object" else [*catalog.robots, *catalog.bystanders]:
        entries = tuple(_entries(gap, kind, model))
        instance = next(scene_instances(gap.scene), None)
        if instance is None:
            new = _new_file(gap.scene, entries)
            if new is not None:
                name = new.uri.rpartition("/")[2]
                yield Fix(f"Simulate {names} as '{model}': create '{name}' for executions of a .bddx", (), new)
        elif isinstance(instance.tree, tree.SceneInstance) and instance.whole(instance.tree):
            name = instance.uri.rpartition("/")[2]
            yield Fix(f"Simulate {names} as '{model}' in '{name}'", (_added(instance, entries),))


def _entries(gap: Gap, kind: str, model: str) -> Iterator[str]:
    """Yield one entry for each element, or a single entry for all members of a ``similar`` set."""
    references: dict[str, None] = {}
    for element in gap.elements:
        if element.kind == kind:
            owner = element.name.rpartition(".")[0]
            is_similar = _is_similar(gap.scene.snapshot, element.key[0], owner)
            words = f"{_WORDS[kind]} set <{owner}>" if is_similar else f"{_WORDS[kind]} <{element.name}>"
            references.setdefault(words)
    for words in references:
        name = words[words.index("<") + 1 : -1].replace(".", "_")
        yield f'{words} {{ model {name}_model as mjcf {{ catalog "{model}" }} }}'


def _is_similar(snapshot: Snapshot, uri: str, name: str) -> bool:
    file = snapshot.file(uri)
    roots = (placed.declaration.tree for placed in file.declarations) if file is not None else ()
    return any(isinstance(root, tree.SimilarSet) and root.name.text == name for root in roots)


def _new_file(scene: Site, entries: tuple[str, ...]) -> NewFile | None:
    """Return a new ``.scenex`` in the folder of the scene's file.

    Returns ``None`` if this file already exists or if the scene has no namespace.
    """
    root = scene.tree
    symbol = scene.placed.declaration.symbols[0]
    if not isinstance(root, tree.Scene) or symbol.namespace in (None, FILE_NAMESPACE):
        return None
    folder, _, own = scene.uri.rpartition("/")
    uri = f"{folder}/{own.partition('.')[0]}.scenex"
    path = import_path(uri, scene.uri)
    if path is None or uri in scene.snapshot.sources or file_state(uri) is not None:
        return None
    name = root.name.text
    lines = "".join(f"    {entry}\n" for entry in entries)
    head = f"scene inst (ns={symbol.namespace}) {name}_models {{"
    return NewFile(uri, f'import "{path}"\n\n{head}\n    scene: <{name}>\n\n{lines}}}\n')


def _added(instance: Site, entries: tuple[str, ...]) -> Edit:
    """Return the edit that appends entries to an executable scene."""
    root = instance.tree
    assert isinstance(root, tree.SceneInstance)
    document = instance.file.document
    if root.entries:
        end = instance.span(root.entries[-1]).end
    else:
        end = document.text.index(">", instance.span(root.scene).end) + 1
    return Edit(instance.uri, Span(end, end), "".join(f"\n    {entry}" for entry in entries))
