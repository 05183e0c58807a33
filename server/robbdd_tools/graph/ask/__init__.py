"""Questions to a graph: SPARQL, its structure, its picture."""
