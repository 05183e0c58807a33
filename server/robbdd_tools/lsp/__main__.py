"""``python -I -m robbdd_tools.lsp``: the language server, with an interpreter that ignores the environment."""

from robbdd_tools.base.isolation import isolate


def _start() -> int:
    isolate()
    from robbdd_tools.lsp.main import main

    return main()


raise SystemExit(_start())
