"""Find the files that a run used apart from the graph.

These are the models of scenes and arms with the files that they include, and users' Python code. The files are found by
reading, never by importing. Files that code chooses at run time are not found.
"""

from __future__ import annotations

import ast
import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.external_systems import command_words
from robbdd_tools.base.files import load_bytes, path_to_uri, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.model_includes import model_files
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.run.prepare import FEATURES

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import Implementation, ModelSource, Origin, SceneInstance
    from robbdd_tools.protocol.specs import ExecutionSpec, Manifest


def digests(manifest: Manifest, folder: Path) -> dict[str, str]:
    """Return the SHA-256 digest of each file that a run uses, by the path of the file relative to the run folder."""
    return {name: _digest(path) for name, path in _named(manifest, folder).items()}


def used_paths(manifest: Manifest, folder: Path) -> list[Path]:
    """Return the paths of those files of ``digests`` that still exist."""
    return [path for path in _named(manifest, folder).values() if path.is_file()]


def imported_by_steps(manifest: Manifest) -> list[Path]:
    """Return the files in the folders of the models that the steps of users import."""
    folders = dict.fromkeys(_folder(None, spec.model).resolve() for spec in manifest.scenarios)
    names = {name for original in manifest.sources.values() for name in _imports(Path(original))}
    found = (path for folder in folders for name in sorted(names) for path in _modules(name, folder))
    return list(dict.fromkeys(found))


def changed(known: Mapping[str, str], folder: Path) -> list[Path]:
    """Return the files of ``digests`` whose content has changed."""
    paths = ((folder / name).resolve() for name in known)
    return [path for path, digest in zip(paths, known.values(), strict=True) if _digest(path) != digest]


def added(known: Mapping[str, str], manifest: Manifest, folder: Path) -> list[Path]:
    """Return the files that the manifest's scenarios would use now, but that ``digests`` does not contain."""
    return [path for name, path in _named(manifest, folder).items() if name not in known]


def prepared_digest(folder: Path) -> str:
    """Return the SHA-256 digest of the prepared content of a run folder: the manifest, the features and their steps."""
    every = (path for path in (folder / FEATURES).rglob("*") if path.is_file() and path.suffix != ".pyc")
    found = {path.relative_to(folder).as_posix(): _digest(path) for path in (folder / MANIFEST, *every)}
    return hashlib.sha256(json.dumps(found, sort_keys=True).encode()).hexdigest()


def _named(manifest: Manifest, folder: Path) -> dict[str, Path]:
    found = sorted({path.resolve() for path in _used(manifest)})
    return {Path(os.path.relpath(path, folder.resolve())).as_posix(): path for path in found}


def _digest(path: Path) -> str:
    try:
        return hashlib.sha256(load_bytes(path, RESULT_SIZE)).hexdigest()
    except OSError:
        return ""


def _used(manifest: Manifest) -> Iterator[Path]:
    executions = {spec.execution.iri: (spec.execution, spec.model) for spec in manifest.scenarios if spec.execution}
    for execution, model in executions.values():
        if execution.scene is not None:
            yield from _model_files(execution.scene, model)
        for name, origin in _code(execution):
            yield from _modules(name, _folder(origin, model))
        if execution.implementation.kind == "process":
            yield from _command_files(execution.implementation, model)
    chosen = {
        spec.chosen_instance.iri: (spec.chosen_instance, spec.model)
        for spec in manifest.scenarios
        if spec.chosen_instance
    }
    for instance, model in chosen.values():
        # The graph of the model does not contain the text of a chosen .scenex, nor the graphs that it imports.
        yield from (Path(file) for file in _texts(instance))
        yield from _graphs(instance)
        yield from _model_files(instance, model)


def _texts(instance: SceneInstance) -> Iterator[str]:
    """Yield the paths of the model files that declare a scene instance and its parts."""
    parts = (instance, *instance.elements, *instance.bodies, *instance.links, *instance.laws)
    yield from dict.fromkeys(part.origin.file for part in parts if part.origin is not None)


def _graphs(instance: SceneInstance) -> Iterator[Path]:
    """Yield the files of the graphs that the text of a scene instance imports, directly or not."""
    from robbdd_tools.graph.write.imported_graphs import imported_graph
    from robbdd_tools.names.project import Project

    if instance.origin is None:
        return
    project, uri = Project(), path_to_uri(Path(instance.origin.file))
    project.load(uri)
    paths = (uri_to_path(document.uri) for document in imported_graph(project.snapshot(), uri).documents)
    yield from (path for path in paths if path is not None)


def _model_files(instance: SceneInstance, model: str) -> Iterator[Path]:
    for source in instance.sources:
        if source.kind == "python":
            yield from _modules(source.name, _folder(source.origin, model))
        elif source.kind in ("file", "ros"):
            yield from (path for path in model_files(_path(source)) if path.is_file())


def _code(execution: ExecutionSpec) -> Iterator[tuple[str, Origin | None]]:
    """Yield each name of users' code (``module:attribute``) with the place of the reference, if known."""
    if execution.implementation.kind == "python":
        yield execution.implementation.name, execution.implementation.origin
    for policy in execution.policies:
        if policy.rule.kind == "python":
            yield policy.rule.name, None
        for observation in policy.observations:
            yield from ((name, None) for name in (observation.entity_mapper, observation.time_extractor) if name)


def _command_files(implementation: Implementation, model: str) -> Iterator[Path]:
    """Yield the files in the model's folder that the command of a process names, and the files that they import."""
    folder = _folder(implementation.origin, model)
    for word in command_words(implementation.name):
        path = folder / word
        if path.is_file():
            yield path
            if path.suffix == ".py" and path.parent == folder:
                yield from _modules(path.stem, folder)


def _folder(origin: Origin | None, model: str) -> Path:
    if origin is not None:
        return Path(origin.file).parent
    path = uri_to_path(model) if model.startswith("file:") else Path(model)
    return Path() if path is None else path.parent


def _path(source: ModelSource) -> Path:
    path = Path(source.name).expanduser()
    if source.kind == "ros":
        prefixes = filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep))
        shares = (Path(prefix) / "share" / source.package for prefix in prefixes)
        return next((share / path for share in shares if share.is_dir()), path)
    return path if source.origin is None else Path(source.origin.file).parent / path


def _modules(name: str, folder: Path) -> Iterator[Path]:
    """Yield the file that defines ``module:attribute`` in a folder, and the files in that folder that it imports."""
    seen: dict[Path, None] = {}
    waiting = [name.partition(":")[0]]
    while waiting:
        path = _module(waiting.pop(), folder)
        if path is None or path in seen:
            continue
        seen[path] = None
        yield path
        waiting += _imports(path)


def _module(name: str, folder: Path) -> Path | None:
    base = folder.joinpath(*name.split("."))
    return next((one for one in (base.with_suffix(".py"), base / "__init__.py") if one.is_file()), None)


def _imports(path: Path) -> Iterable[str]:
    try:
        module = ast.parse(load_bytes(path))
    except (SyntaxError, ValueError, OSError):
        return
    for node in ast.walk(module):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
