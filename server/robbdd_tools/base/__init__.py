"""Types and helpers that all layers share: documents, ranges, diagnostics and data files."""
