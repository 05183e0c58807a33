"""``robbdd cut``: cut hollow meshes into convex pieces, with which they collide."""

from __future__ import annotations

from pathlib import Path

from robbdd_tools.base.interpreter import run
from robbdd_tools.base.model_includes import PIECES, pieces_beside
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line

MODELS = (".xml", ".mjcf", ".urdf")
AGENT = "robbdd_tools.agent.cut_meshes"


def cut(path: Path, threshold: float, *, again: bool) -> int:
    """Cut a mesh, or the hollow collision meshes of a model; return the exit code.

    Meshes that have been cut are left out, unless they are to be cut ``again``.
    """
    file = path.expanduser().absolute()
    if not file.is_file():
        return fail(f"there is no file {path}")
    if file.suffix.lower() not in MODELS:
        return _cut_all({file: ""}, threshold)
    found = run(AGENT, "find", str(file))
    if found.returncode != 0:
        return fail(f"{path}: {found.stderr.strip()}")
    hollow = {Path(place): share for share, place in (line.split("\t", 1) for line in found.stdout.splitlines())}
    due = {mesh: share for mesh, share in hollow.items() if again or not pieces_beside(mesh).is_file()}
    if not hollow:
        print_line(f"{path}: no collision mesh is hollow")
    for mesh in (mesh for mesh in hollow if mesh not in due):
        print_line(f"{mesh.name}: has been cut (--force cuts it again)")
    return _cut_all(due, threshold)


def _cut_all(meshes: dict[Path, str], threshold: float) -> int:
    """Cut meshes; the values say how many times their volume their convex hulls have, if this is known."""
    for mesh, share in meshes.items():
        hull = f", whose convex hull has {share} times its volume" if share else ""
        print_line(f"{mesh.name}{hull}: this may take minutes")
        done = run(AGENT, "cut", str(mesh), str(threshold))
        if done.returncode != 0:
            return fail(done.stderr.strip().rpartition("\n")[2] or f"{mesh.name} was not cut")
        pieces, _, volume = done.stdout.strip().partition("\t")
        times = f" with {volume} times its volume" if float(volume) else ""
        print_line(f"    {pieces} pieces{times}: {mesh.name}{PIECES}")
    return OK
