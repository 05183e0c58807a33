"""Path of the user's own configuration."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def user_file() -> Path:
    """Return the path of the user's own configuration, which no opened folder can supply; the file may be missing.

    It is ``ROBBDD_CONFIG``, else ``robbdd/robbdd.toml`` in the platform's configuration folder.
    """
    own = os.environ.get("ROBBDD_CONFIG", "")
    if Path(own).is_absolute():
        return Path(own)
    variable, default = {
        "win32": ("APPDATA", "AppData/Roaming"),
        "darwin": ("", "Library/Application Support"),
    }.get(sys.platform, ("XDG_CONFIG_HOME", ".config"))
    stated = os.environ.get(variable, "")
    folder = Path(stated) if Path(stated).is_absolute() else Path.home() / default
    return folder / "robbdd" / "robbdd.toml"
