"""Entry points of the commands: they clean Python's module path before any other import.

``server/scripts`` hides ``PYTHONPATH`` from the interpreter if a shell starts the commands. On Windows, and if
``robbdd.py`` is started directly, the interpreter has already read it: its folders are removed from ``sys.path`` here.
This cannot cover modules that Python imports before its first script (``encodings``, ``sitecustomize``).
"""

from __future__ import annotations

from robbdd_tools.base.isolation import isolate


def robbdd() -> int:
    """Run the command line and return its exit code."""
    isolate()
    from robbdd_tools.cli import main

    return main()


def robbdd_lsp() -> int:
    """Run the language server and return its exit code."""
    isolate()
    from robbdd_tools.lsp.main import main

    return main()
