"""Text to declarations: split into chunks, each parsed by textX into a tree with its errors."""
