"""Load, check, plan, run and judge models, for the command line, the language server, pytest and notebooks."""
