"""Names of files that every file system accepts."""

from __future__ import annotations

RESERVED = frozenset(
    ("con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in "0123456789¹²³"))
)
"""Names of devices. Windows does not allow them as names of files, even with an extension."""


def safe_stem(name: str) -> str:
    """Return a stem for a file name, made from ``name``. Whatever some file system refuses is replaced."""
    stem = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in name).strip(".") or "_"
    return f"_{stem}" if stem.partition(".")[0].casefold() in RESERVED else stem
