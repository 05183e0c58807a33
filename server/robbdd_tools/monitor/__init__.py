"""Traces, time windows, verdicts and robustness.

Only numpy and the standard library are used, no simulator or behave.
"""
