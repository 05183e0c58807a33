"""Entry points of the commands: they clean Python's module path before anything else is imported.

``server/scripts`` keeps ``PYTHONPATH`` from the interpreter where a shell starts the commands. On Windows, and where
``robbdd.py`` is started directly, the interpreter has read it already: its folders are removed from ``sys.path`` here.
Modules that Python imports before its first script (``encodings``, ``sitecustomize``) are beyond our reach then.
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
