"""Clean Python's module path in a running interpreter. Imports nothing that could be planted in a folder."""

from __future__ import annotations

# All three are built into a running interpreter and are not searched for on sys.path.
import os
import site
import sys

SEARCHED = "PYTHONPATH"
INHERITED = "ROBBDD_PYTHONPATH"
"""Name of an environment variable. It passes ``PYTHONPATH`` to the agent, which searches the absolute folders last."""
NO_USER_CODE = "ROBBDD_NO_USER_CODE"
"""Name of an environment variable. If it is set, none of our processes imports users' code."""
EXPOSED = (
    "warning: PYTHONPATH has an empty or relative entry, so Python searched the working directory before RobBDD began: "
    "remove this entry, or use python -I -m robbdd_tools\n"
)
UNTRUSTED = "untrusted"
"""``NO_USER_CODE`` has this value if the workspace is not trusted, but not if ``--no-user-code`` was given."""
OWNER_FORBIDS = "worker"
"""``NO_USER_CODE`` has this value on a cluster worker if the worker's owner does not allow users' code."""
WORKER_USER_CODE = "ROBBDD_WORKER_USER_CODE"
"""Name of an environment variable of cluster workers. Its value ``allow`` permits users' code."""


def isolate() -> None:
    """Remove the working directory, the script's folder and the folders of ``PYTHONPATH`` from ``sys.path``.

    A folder of ``PYTHONPATH`` that contains this package is moved to the end instead, because an installation by ``pip
    install --target`` has its libraries there. If Python has searched the working directory, a warning is printed.
    """
    stated = os.environ.pop(SEARCHED, None)
    if stated is not None:
        os.environ[INHERITED] = stated
    added = [] if stated is None else stated.split(os.pathsep)
    removed = {os.path.abspath(entry) for entry in added} | {""}
    if not sys.flags.safe_path:
        removed.add(sys.path[0])
    removed -= _installed()
    package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path[:] = [entry for entry in sys.path if entry not in removed]
    if package in added:
        sys.path.append(package)
    if stated and not sys.flags.ignore_environment and not all(map(os.path.isabs, added)):
        sys.stderr.write(EXPOSED)


def _installed() -> set[str]:
    """Return the folders of the interpreter's own installation. They must stay even if ``PYTHONPATH`` names them."""
    library = os.path.dirname(os.__file__)
    own = site.USER_SITE if site.ENABLE_USER_SITE else None
    return {library, os.path.join(library, "lib-dynload"), *site.getsitepackages(), *([own] if own else [])}
