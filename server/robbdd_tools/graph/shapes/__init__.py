"""SHACL: the shapes, the statements derived for them, and their findings mapped to text."""
