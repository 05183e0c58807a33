"""The client's settings for the server.

The server requests them or, if the client cannot answer, uses those it sends.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, cast

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.limits import use_limits
from robbdd_tools.graph.shapes.project_shapes import EditorShapes

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

SECTION = "robbdd"


class Settings:
    """The settings ``robbdd.shapes`` and ``robbdd.run.bhv`` of each workspace folder.

    Folders are given by URI; ``""`` holds the settings for files outside of all folders.
    """

    def __init__(self) -> None:
        self._shapes: dict[str, tuple[str, ...]] = {}
        self._substitutions: dict[str, dict[str, str]] = {}
        self.sent: object = None
        """Settings that the client has sent unasked, for all folders."""

    @property
    def patterns(self) -> dict[str, tuple[str, ...]]:
        """The file patterns of shapes for each folder that has any."""
        return {folder: patterns for folder, patterns in self._shapes.items() if patterns}

    def set(self, folder: str, section: object) -> str | None:
        """Apply the section ``robbdd`` of a folder's settings. Return a description of the errors in it, if any."""
        limits = use_limits(cast("dict[str, Any]", section).get("limits")) if isinstance(section, dict) else None
        if limits is not None:
            return limits
        stated = cast("dict[str, Any]", section).get("shapes") if isinstance(section, dict) else None
        patterns = cast("list[object]", stated or []) if isinstance(stated or [], list) else [None]
        texts = tuple(pattern for pattern in patterns if isinstance(pattern, str))
        if len(texts) != len(patterns):
            return "The setting 'robbdd.shapes' is a list of file patterns, such as [\"shapes/*.ttl\"]."
        self._shapes[folder] = texts
        return self._set_substitutions(folder, cast("dict[str, Any]", section) if isinstance(section, dict) else {})

    def _set_substitutions(self, folder: str, section: Mapping[str, Any]) -> str | None:
        run: object = section.get("run")
        stated = cast("dict[str, Any]", run).get("bhv") if isinstance(run, dict) else None
        entries = cast("dict[str, object]", stated or {}) if isinstance(stated or {}, dict) else {"": None}
        texts = {name: behaviour for name, behaviour in entries.items() if isinstance(behaviour, str)}
        if len(texts) != len(entries):
            return 'The setting \'robbdd.run.bhv\' is an object such as { "my-server": "pick-place" }.'
        self._substitutions[folder] = texts
        return None

    def forget_others(self, folders: Collection[str]) -> None:
        """Drop the settings of folders that are no longer part of the workspace."""
        self._shapes = {folder: patterns for folder, patterns in self._shapes.items() if folder in folders}
        self._substitutions = {folder: texts for folder, texts in self._substitutions.items() if folder in folders}

    def substitutions(self, uri: str) -> dict[str, str]:
        """Return the catalog behaviours that runs of a model execute instead of implementations in its ``.bddx``."""
        return self._substitutions.get(self._folder_of(uri), {})

    def shapes(self, uri: str) -> EditorShapes:
        """Return the file patterns of the shapes that the editor adds for a document.

        Patterns are relative to the workspace folder of the document.
        """
        folder = self._folder_of(uri)
        path = uri_to_path(folder) if folder else None
        if path is None:
            document = uri_to_path(uri)
            path = None if document is None else document.parent
        patterns = self._shapes.get(folder, ())
        return EditorShapes() if path is None else EditorShapes(str(path), patterns)

    def _folder_of(self, uri: str) -> str:
        """Return the innermost workspace folder of a document; ``""`` if it is outside of all folders."""
        inside = [folder for folder in self._shapes if folder and uri.startswith(f"{folder.rstrip('/')}/")]
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
    if ls.settings.patterns != before:
        await ls.settings_changed()
