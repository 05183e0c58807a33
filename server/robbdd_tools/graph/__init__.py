"""The knowledge graph: conversion of syntax trees to RDF and back to plain data, source map, JSON-LD and SHACL."""
