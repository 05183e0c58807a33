"""Calls of code that users bring with their models; only the agent process imports it."""
