"""Judge clauses on a trace, recorded by a simulation or read from a file, without a simulator."""
