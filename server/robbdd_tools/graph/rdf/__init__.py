"""RDF itself: vocabulary, prefixes, contexts, lists, records, reading and writing of its formats."""
