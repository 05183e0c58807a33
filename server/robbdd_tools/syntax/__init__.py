"""Parse text into declarations. The text is split into chunks, and each chunk is parsed into a tree with its errors."""
