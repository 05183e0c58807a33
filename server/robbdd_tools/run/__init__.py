"""Launching, cancelling and keeping runs; the agent process itself is never imported here."""
