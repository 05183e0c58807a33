"""Decisions from many executions: rates with their intervals, comparisons, reports."""
