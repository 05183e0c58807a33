"""Symbols, scopes, imports and references across files; Project (mutable) and Snapshot (immutable)."""
