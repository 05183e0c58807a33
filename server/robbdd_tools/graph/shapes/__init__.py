"""SHACL: the shapes, what they need to be derived, and what they find, on the text."""
