"""``robbdd view``: a picture of a scenario's initial scene, with its workspaces labelled."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.models import sound_model
from robbdd_tools.commands.output import fail, print_line
from robbdd_tools.run.pictures import NoPictures, render_scene
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.user_code import refusal

if TYPE_CHECKING:
    from robbdd_tools.run.protocol import Manifest


def view(path: Path, name: str | None, seed: int | None, output: Path | None) -> int:
    """Write the picture of the first scenario, or of that called ``name``; returns the exit code."""
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.places import placed_model

    snapshot = sound_model(path)
    if snapshot is None:
        return FAILED
    model = placed_model(build_graph(snapshot, path_to_uri(path)), snapshot)
    target = output or Path(f"{path.stem}.png")
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        request = RunRequest(model, str(path)) if seed is None else RunRequest(model, str(path), seed)
        manifest = prepare(request, Path(folder))
        index = _index(manifest, name)
        if index is None:
            known = dict.fromkeys(_variant(scenario.name) for scenario in manifest.scenarios)
            wanted = "no scenario" if name is None else f"no scenario '{name}'; the model has {', '.join(known)}"
            return fail(f"there is {wanted}")
        problem = refusal(replace(manifest, scenarios=(manifest.scenarios[index],)), Path(folder), judges=False)
        if problem:
            return fail(problem)
        try:
            render_scene(Path(folder), index, target)
        except NoPictures as error:
            return fail(str(error))
    print_line(f"{target}: {manifest.scenarios[index].name}")
    return OK


def _index(manifest: Manifest, name: str | None) -> int | None:
    """Return the first scenario of a name: the whole one, or that of its variant."""
    for index, scenario in enumerate(manifest.scenarios):
        if name is None or name in (scenario.name, _variant(scenario.name)):
            return index
    return None


def _variant(scenario: str) -> str:
    return scenario.rpartition(" -- ")[0].rpartition(":")[2]
