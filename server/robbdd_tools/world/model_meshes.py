"""The files of a model's meshes, and which of the meshes are hollow."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

from robbdd_tools.base.model_includes import model_files, pieces_beside
from robbdd_tools.base.model_paths import mesh_places
from robbdd_tools.base.source_texts import source_xml
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import make_solid
from robbdd_tools.world.mesh_pieces import CUT, HOLLOW, hollowness, is_in_hull, pieces_of, use_pieces
from robbdd_tools.world.mjcf_files import read_mjcf
from robbdd_tools.world.owners import is_scenery
from robbdd_tools.world.urdf_files import is_urdf, mesh_address, read_urdf

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator

    from robbdd_tools.catalog.executable import ModelSource


def read_model(path: Path) -> Any:
    """Return the engine's editable description of a model file, in which cut meshes collide as their pieces.

    Raises ``ValueError`` and ``OSError``.
    """
    spec, files = read_whole(path)
    use_pieces(spec, files)
    return spec


def read_whole(path: Path) -> tuple[Any, dict[str, Path]]:
    """Return the description of a model file with whole meshes, and the files of the meshes by their names in it.

    Raises ``ValueError`` and ``OSError``.
    """
    if is_urdf(path):
        spec, root = read_urdf(path), ElementTree.fromstring(source_xml(path))
        addresses = (mesh.get("filename", "") for mesh in root.iter("mesh"))
        places = (next((one for one in mesh_places(path, name) if one.is_file()), None) for name in addresses)
        known = {name: place for place in places if place is not None for name in (str(place), mesh_address(place))}
        found = {str(mesh.name): known.get(mesh.file) or known.get(Path(mesh.file).stem) for mesh in spec.meshes}
    else:
        spec, named = read_mjcf(path), list(model_files(path, source_xml))
        found = {str(mesh.name): _ending(named, str(mesh.file)) for mesh in spec.meshes}
    return spec, {name: file for name, file in found.items() if file is not None}


def _ending(files: Iterable[Path], address: str) -> Path | None:
    """Return the first file whose path ends with an address; the folders of meshes are settings of the compiler."""
    parts = tuple(part for part in Path(address).parts if part not in ("..", "."))
    return next((one for one in files if parts and one.parts[-len(parts) :] == parts), None)


def whole_meshes(path: Path) -> dict[Path, float]:
    """Return the hollow collision meshes of a model file that have not been cut, with how hollow they are.

    Raises ``ValueError`` and ``OSError``.
    """
    return {mesh: share for mesh, share in hollow_files(path).items() if not pieces_of(mesh)}


def hollow_files(path: Path) -> dict[Path, float]:
    """Return the files of a model's hollow collision meshes, sorted, with how hollow they are, also of those cut here.

    Moving links without collision shapes collide as their visual ones, as in arms.
    Raises ``ValueError`` and ``OSError``.
    """
    spec, files = read_whole(path)
    spec = spec.copy()
    make_solid(spec)
    # Only the shapes matter: masses and inertias that no body can have are no reason to fail.
    spec.compiler.balanceinertia, spec.compiler.boundmass, spec.compiler.boundinertia = True, 1.0, 1.0
    hollow = hollow_meshes(spec.compile())
    found = sorted((files[name], share) for name, share in hollow.items() if name in files)
    return {mesh: share for mesh, share in found if pieces_beside(mesh).is_file() or not pieces_of(mesh)}


def refuse_filled(model: Any, data: Any, sites: Iterable[int], bodies: Container[int], source: ModelSource) -> None:
    """Refuse a workspace whose middle is inside the convex hull of a mesh of ``bodies``: nothing can lie in it.

    Raises ``SceneError``.
    """
    for geom in _colliding_meshes(model, bodies):
        mesh = int(model.geom_dataid[geom])
        for site in sites:
            point = data.geom_xmat[geom].reshape(3, 3).T @ (data.site_xpos[site] - data.geom_xpos[geom])
            if is_in_hull(model, mesh, point):
                filled = f"the mesh '{model.mesh(mesh).name}' collides as its convex hull, which fills the workspace"
                raise SceneError(f"in {source.name}, {filled} '{model.site(site).name}'; {CUT}", origin=source.origin)


def hollow_scenery(model: Any) -> dict[str, float]:
    """Return the hollow collision meshes in the models of the whole scene, with how hollow they are."""
    found = ((name.partition("/"), share) for name, share in hollow_meshes(model).items())
    return {mesh: share for (owner, _, mesh), share in found if is_scenery(owner)}


def hollow_meshes(model: Any, bodies: Container[int] | None = None) -> dict[str, float]:
    """Return the meshes of a compiled model that collide although they are hollow, with how hollow they are.

    Only those of ``bodies`` are returned if they are given.
    """
    colliding = {int(model.geom_dataid[geom]) for geom in _colliding_meshes(model, bodies)}
    shares = {str(model.mesh(mesh).name): hollowness(model, mesh) for mesh in sorted(colliding)}
    return {name: share for name, share in shares.items() if share is not None and share >= HOLLOW}


def _colliding_meshes(model: Any, bodies: Container[int] | None) -> Iterator[int]:
    """Yield the geoms that collide as meshes, only those of ``bodies`` if they are given."""
    for geom in range(model.ngeom):
        is_mesh = model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH
        is_own = bodies is None or int(model.geom_bodyid[geom]) in bodies
        if is_mesh and is_own and model.geom_contype[geom] | model.geom_conaffinity[geom]:
            yield geom
