"""Judge clauses on a trace, which was recorded by a simulation or read from a file. No simulator is needed."""
