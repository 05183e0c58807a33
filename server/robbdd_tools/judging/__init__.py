"""Decides clauses on a trace, recorded by a simulation or read from a file; knows no simulator."""
