"""The files that a user names: files, and the models in folders."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.graph_formats import GRAPH_FORMATS, graph_format
from robbdd_tools.syntax.parse import LANGUAGES


class NotAModel(RobbddError):
    """The file does not exist, or its name does not have the ending of a model."""


def named_files(paths: Sequence[Path], others: Collection[str] = ()) -> list[Path]:
    """Return the files, with each folder replaced by the model files below it, in alphabetical order.

    ``others`` are the endings, without the dot, of further files that may be named and that are wanted from folders.
    Hidden folders, installed packages and virtual environments are skipped. Raises ``NotAModel``.
    """
    files: dict[Path, None] = {}
    for path in paths:
        if path.is_dir():
            files |= dict.fromkeys(sorted(_own_files(path, (*LANGUAGES, *others))))
        else:
            files.setdefault(path)
    if not files:
        raise NotAModel(f"there is no model in {', '.join(map(str, paths))}")
    refuse_other_files(path for path in files if path.suffix[1:] not in others or not path.exists())
    return list(files)


def refuse_other_files(paths: Iterable[Path], *, must_exist: bool = True) -> None:
    """Raise ``NotAModel`` for a path whose name does not have the ending of a model, or that does not exist."""
    for path in paths:
        if path.suffix[1:].lower() in LANGUAGES or graph_format(path.name) or path.is_dir():
            continue
        if must_exist and not path.exists():
            raise NotAModel(f"there is no file or folder {path}")
        endings = ", ".join(f".{ending}" for ending in (*LANGUAGES, *GRAPH_FORMATS))
        raise NotAModel(f"{path} is not a model: its name must end in one of {endings}")


def _own_files(folder: Path, endings: Collection[str]) -> Iterator[Path]:
    for parent, folders, names in os.walk(folder):
        here = Path(parent)
        folders[:] = [name for name in folders if not _is_foreign(here / name)]
        yield from (here / name for name in names if Path(name).suffix[1:] in endings)


def _is_foreign(folder: Path) -> bool:
    return folder.name.startswith(".") or folder.name == "node_modules" or (folder / "pyvenv.cfg").is_file()
