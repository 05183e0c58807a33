"""From declarations to RDF, with the place in the text of every node; graphs by others; results of runs."""
