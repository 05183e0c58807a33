"""The process that executes scenarios.

It runs behave with its steps, executes behaviours, and reports to the parent.
"""
