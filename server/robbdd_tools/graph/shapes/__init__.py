"""SHACL: the shapes, the statements that the shapes need, and the mapping of findings to text."""
