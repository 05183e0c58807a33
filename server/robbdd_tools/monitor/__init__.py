"""Traces, time windows, verdicts and robustness: numpy and the standard library, no simulator, no behave."""
