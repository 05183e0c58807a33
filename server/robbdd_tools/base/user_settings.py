"""Path of the user's own configuration."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def user_file() -> Path:
    """Return the path of the user's own configuration. The file need not exist.

    The path is ``ROBBDD_CONFIG`` or, if that is not set, ``robbdd/robbdd.toml`` in the configuration folder of the
    platform. So no opened folder can supply the file.
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
