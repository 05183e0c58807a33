"""The folder of data that can be fetched or computed again."""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path:
    """Return ``ROBBDD_CACHE``, or the user's cache folder if that is not set."""
    own = os.environ.get("ROBBDD_CACHE")
    if own:
        return Path(own)
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA")
    return (Path(base) if base else Path.home() / ".cache") / "robbdd-tools"
