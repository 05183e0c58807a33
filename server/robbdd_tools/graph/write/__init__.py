"""Write declarations as RDF with source positions; read foreign graphs; add results of runs."""
