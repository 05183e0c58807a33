"""The knowledge graph: trees to RDF and back to plain data, source map, JSON-LD, SHACL."""
