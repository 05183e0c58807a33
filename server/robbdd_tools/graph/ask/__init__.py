"""Query a graph: SPARQL, its structure, its picture."""
