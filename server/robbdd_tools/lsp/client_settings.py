"""The client's settings for the server.

The server requests them. If the client cannot answer, the server uses the settings that the client sends.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, cast

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.limits import use_limits
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp.run_options import RunDefaults

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

SECTION = "robbdd"


@dataclass(frozen=True, slots=True)
class FolderSettings:
    """The settings of one workspace folder.

    - ``shapes``: file patterns of SHACL shapes, relative to the folder.
    - ``bhv``: maps implementations of behaviours to the catalog behaviours that runs execute instead.
    - ``scenex``: paths of ``.scenex`` files, relative to the folder, for scenarios without an execution.
    - ``rejudge``: whether each edit of a clause is judged on stored traces.
    - ``expand``: whether features show the definitions of named predicates in place of their phrases.
    """

    shapes: tuple[str, ...] = ()
    bhv: Mapping[str, str] = field(default_factory=dict[str, str])
    scenex: tuple[str, ...] = ()
    rejudge: bool = True
    expand: bool = False

    def read(self, section: object) -> tuple[FolderSettings, str | None]:
        """Read the section ``robbdd`` of a folder's settings. Return them with a description of the first error.

        A setting that does not have its documented form keeps its value.
        """
        stated = _entries(section) or {}
        run = _entries(stated.get("run")) or {}
        shapes, bhv, scenex = _texts(stated.get("shapes")), _named_texts(run.get("bhv")), _texts(run.get("scenex"))
        problem, rejudge = None, stated.get("rejudge", True)
        if not isinstance(rejudge, bool):
            problem, rejudge = "The setting 'robbdd.rejudge' is true or false.", self.rejudge
        expand = (_entries(stated.get("gherkin")) or {}).get("expandPredicates", False)
        if not isinstance(expand, bool):
            problem, expand = "The setting 'robbdd.gherkin.expandPredicates' is true or false.", self.expand
        if scenex is None or not all(path.endswith(".scenex") for path in scenex):
            scenex = self.scenex
            problem = "The setting 'robbdd.run.scenex' is a list of .scenex files, such as [\"cell.scenex\"]."
        if bhv is None:
            problem = 'The setting \'robbdd.run.bhv\' is an object such as { "my-server": "pick-place" }.'
        if shapes is None:
            problem = "The setting 'robbdd.shapes' is a list of file patterns, such as [\"shapes/*.ttl\"]."
        found = FolderSettings(
            self.shapes if shapes is None else shapes,
            self.bhv if bhv is None else bhv,
            scenex,
            rejudge,
            expand,
        )
        return found, problem


def _entries(value: object) -> dict[str, object] | None:
    return cast("dict[str, object]", value) if isinstance(value, dict) else None


def _texts(value: object) -> tuple[str, ...] | None:
    """Return the texts of a list. A missing list is empty; the result is ``None`` for any other value."""
    entries = cast("list[object]", value or []) if isinstance(value or [], list) else [None]
    texts = tuple(entry for entry in entries if isinstance(entry, str))
    return texts if len(texts) == len(entries) else None


def _named_texts(value: object) -> dict[str, str] | None:
    """Return an object with texts as values. A missing one is empty; the result is ``None`` for any other value."""
    entries = _entries(value or {})
    texts = {name: text for name, text in (entries or {}).items() if isinstance(text, str)}
    return texts if entries is not None and len(texts) == len(entries) else None


class Settings:
    """The settings of each workspace folder.

    Folders are given by URI; ``""`` holds the settings for files outside of all folders.
    """

    def __init__(self) -> None:
        self._folders: dict[str, FolderSettings] = {}
        self.sent: object = None
        """Settings that the client has sent unasked, for all folders."""

    @property
    def patterns(self) -> dict[str, tuple[str, ...]]:
        """The file patterns of shapes for each folder that has any."""
        return {folder: settings.shapes for folder, settings in self._folders.items() if settings.shapes}

    def set(self, folder: str, section: object) -> str | None:
        """Apply the section ``robbdd`` of a folder's settings. Return a description of the errors in it, if any."""
        stated = _entries(section)
        limits = None if stated is None else use_limits(stated.get("limits"))
        if limits is not None:
            return limits
        self._folders[folder], problem = self._folders.get(folder, FolderSettings()).read(section)
        return problem

    def forget_others(self, folders: Collection[str]) -> None:
        """Drop the settings of folders that are no longer part of the workspace."""
        self._folders = {folder: settings for folder, settings in self._folders.items() if folder in folders}

    def run_defaults(self, uri: str) -> RunDefaults:
        """Return the settings for runs of a document."""
        folder, settings = self._of(uri)
        return RunDefaults(settings.bhv, tuple((folder or Path()) / path for path in settings.scenex))

    def rejudges(self, uri: str) -> bool:
        """Return whether edits of a document are judged on stored traces."""
        return self._of(uri)[1].rejudge

    def expands(self, uri: str) -> bool:
        """Return whether the features of a document show the definitions of named predicates."""
        return self._of(uri)[1].expand

    def shapes(self, uri: str) -> EditorShapes:
        """Return the file patterns of the shapes that the editor adds for a document.

        Patterns are relative to the workspace folder of the document.
        """
        folder, settings = self._of(uri)
        return EditorShapes() if folder is None else EditorShapes(str(folder), settings.shapes)

    def _of(self, uri: str) -> tuple[Path | None, FolderSettings]:
        """Return the workspace folder of a document, or the document's own folder outside of all, with its settings."""
        folder = self._folder_of(uri)
        path, document = uri_to_path(folder) if folder else None, uri_to_path(uri)
        if path is None and document is not None:
            path = document.parent
        return path, self._folders.get(folder, FolderSettings())

    def _folder_of(self, uri: str) -> str:
        """Return the innermost workspace folder of a document; ``""`` if it is outside of all folders."""
        inside = [folder for folder in self._folders if folder and uri.startswith(f"{folder.rstrip('/')}/")]
        return max(inside, key=len, default="")


def register_settings(server: RobbddServer) -> None:
    """Follow the client's settings."""

    @server.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    async def changed(ls: RobbddServer, params: types.DidChangeConfigurationParams) -> None:
        sent = cast("object", params.settings)
        ls.settings.sent = cast("dict[str, object]", sent).get(SECTION) if isinstance(sent, dict) else None
        await read_settings(ls)


async def follow_settings(ls: RobbddServer) -> None:
    """Read the settings initially, and subscribe to changes."""
    workspace = ls.client_capabilities.workspace
    changes = workspace.did_change_configuration if workspace else None
    if changes is not None and changes.dynamic_registration:
        options = types.DidChangeConfigurationRegistrationOptions(section=SECTION)
        entry = types.Registration(
            id="robbdd-settings", method=types.WORKSPACE_DID_CHANGE_CONFIGURATION, register_options=options
        )
        # A client may refuse the subscription; its settings are still read.
        with suppress(JsonRpcException):
            await ls.client_register_capability_async(types.RegistrationParams(registrations=[entry]))
    await read_settings(ls)


async def read_settings(ls: RobbddServer) -> None:
    """Request the settings of each folder.

    If the client does not support such requests, the last settings that it sent are used.
    """
    before = ls.settings.patterns
    folders = ["", *ls.workspace.folders]
    workspace = ls.client_capabilities.workspace
    if workspace is not None and workspace.configuration:
        items = [types.ConfigurationItem(scope_uri=folder or None, section=SECTION) for folder in folders]
        sections = await ls.workspace_configuration_async(types.ConfigurationParams(items=items))
    else:
        sections = [ls.settings.sent] * len(folders)
    ls.settings.forget_others(folders)
    problems = dict.fromkeys(
        problem
        for folder, section in zip(folders, sections, strict=False)
        if (problem := ls.settings.set(folder, section))
    )
    for problem in problems:
        ls.warn(problem, types.MessageType.Warning)
    ls.rejudging.settings_changed()
    if ls.settings.patterns != before:
        await ls.settings_changed()
