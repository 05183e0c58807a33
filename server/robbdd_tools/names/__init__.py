"""Symbols, scopes, imports and references across files. A ``Project`` is mutable, a ``Snapshot`` is immutable."""
