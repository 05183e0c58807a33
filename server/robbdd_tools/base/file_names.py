"""Names of files that every file system accepts."""

from __future__ import annotations

RESERVED = frozenset(
    ("con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in "0123456789¹²³"))
)
"""Names of devices, which Windows gives to no file, whatever its ending."""


def safe_stem(name: str) -> str:
    """Return a name without what a file system refuses or treats in its own way, as a file's name without ending."""
    stem = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in name).strip(".") or "_"
    return f"_{stem}" if stem.partition(".")[0].casefold() in RESERVED else stem
