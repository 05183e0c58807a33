"""Where the user's own configuration is kept."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def user_file() -> Path:
    """Return the user's own configuration, which no folder that is opened can bring along; it need not exist.

    It is ``ROBBDD_CONFIG``, else ``robbdd/robbdd.toml`` in the platform's folder for configurations.
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
