"""``python -I -m robbdd_tools.lsp``: the language server, with an interpreter that ignores the environment."""

from robbdd_tools.start import robbdd_lsp

raise SystemExit(robbdd_lsp())
