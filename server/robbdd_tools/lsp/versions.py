"""The request ``robbdd/versions``: what this server runs with, for reports of issues. It has no parameters."""

from __future__ import annotations

import asyncio
import platform
from importlib import metadata
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

VERSIONS = "robbdd/versions"


def register_versions(server: RobbddServer) -> None:
    """Add the request to a server."""

    @server.feature(VERSIONS)
    async def versions(_params: Any) -> dict[str, str | None]:
        return {
            "python": f"{platform.python_implementation()} {platform.python_version()}",
            "mujoco": await asyncio.to_thread(_installed, "mujoco"),
        }


def _installed(distribution: str) -> str | None:
    """Return the version of an installed package without importing it."""
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None
