"""Recognise logs by the names of their files. Nothing is read."""

from __future__ import annotations

from pathlib import Path

from robbdd_tools.base.files import uri_to_path

METADATA = "metadata.yaml"
SUFFIXES = (".bag", ".db3", ".mcap", ".csv", ".parquet")


def is_log(path: Path) -> bool:
    """Return whether the name of a path is that of a log: a bag, a file of a bag, or a table."""
    if path.is_dir():
        return (path / METADATA).is_file() or bool(bag_files(path))
    return path.suffix.lower() in SUFFIXES and path.is_file()


def bag_files(folder: Path) -> list[Path]:
    """Return the files of a rosbag2 folder in the order of their names."""
    return sorted(one for one in folder.iterdir() if one.suffix.lower() in (".db3", ".mcap") and one.is_file())


def log_path(uri: str, written: str) -> Path | None:
    """Return the path of a log or table that the file at a URI names; ``None`` if the place is unknown."""
    own = uri_to_path(uri)
    try:
        return None if own is None else own.parent / Path(written).expanduser()
    except RuntimeError:
        # The home folder of an unknown user.
        return None
