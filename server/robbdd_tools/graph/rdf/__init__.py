"""RDF basics: vocabulary, prefixes, contexts, lists, records, parsing and serialising."""
