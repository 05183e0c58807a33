"""Find data files (grammars, metamodels, examples) in a checkout or an installed wheel."""

from __future__ import annotations

from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent


def data_file(folder: str, name: str) -> Path:
    """Return the path of ``name`` in the data folder ``grammar`` or ``metamodels``.

    Raises ``FileNotFoundError`` when the installation lacks it.
    """
    installed = PACKAGE / "data" / folder / name
    checkout = PACKAGE.parent.parent / folder / name
    for candidate in (installed, checkout):
        if candidate.is_file():
            return candidate
    raise FileNotFoundError(f"the installation of robbdd-tools lacks its file {folder}/{name}")


def data_folder(folder: str, name: str) -> Path:
    """Return the path of the folder ``name`` in a data folder. If ``folder`` is empty, ``name`` is the data folder.

    Raises ``FileNotFoundError`` if the installation lacks it.
    """
    for root in (PACKAGE / "data", PACKAGE.parent.parent):
        candidate = root / folder / name
        if candidate.is_dir():
            return candidate
    raise FileNotFoundError(f"the installation of robbdd-tools lacks its folder {folder}/{name}")
