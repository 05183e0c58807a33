"""Load, check, plan, run and judge models: shared by the command line, the language server, pytest and notebooks."""
