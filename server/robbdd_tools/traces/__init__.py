"""Recorded evidence: stored traces, read and written without a simulator."""
