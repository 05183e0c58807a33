"""Names of files that every file system accepts."""

from __future__ import annotations

RESERVED = frozenset(
    ("con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in "0123456789¹²³"))
)
"""Device names, which Windows does not allow for files, whatever their extension."""


def safe_stem(name: str) -> str:
    """Return a name as the stem of a file name. Characters and names that some file system refuses are replaced."""
    stem = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in name).strip(".") or "_"
    return f"_{stem}" if stem.partition(".")[0].casefold() in RESERVED else stem
