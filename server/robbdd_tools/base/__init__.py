"""Documents, ranges, diagnostics and data files: what every layer shares and nothing more."""
