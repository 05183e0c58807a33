"""Types and helpers that every layer shares: documents, ranges, diagnostics, data files."""
