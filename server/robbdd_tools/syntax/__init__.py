"""Parse text into declarations: split it into chunks and parse each into a tree with its errors."""
