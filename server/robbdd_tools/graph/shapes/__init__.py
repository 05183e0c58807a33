"""SHACL: the shapes, the statements that are derived for them, and the mapping of their findings to text."""
