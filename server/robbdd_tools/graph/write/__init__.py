"""Write declarations as RDF with source positions, read foreign graphs, and add results of runs."""
