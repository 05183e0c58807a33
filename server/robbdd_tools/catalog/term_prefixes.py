"""Prefixes of the graph's terms for words of the language."""

from __future__ import annotations

METAMODELS = "https://secorolab.github.io/metamodels/"
WORKBENCH = "https://robbdd.org/metamodels/workbench#"
"""Namespace of terms that the published vocabulary lacks: groups, free text, events in When, narrative, order."""

PREFIXES = {
    "bdd": f"{METAMODELS}acceptance-criteria/bdd#",
    "time": f"{METAMODELS}time#",
    "task": f"{METAMODELS}task#",
    "bhv": f"{METAMODELS}behaviour#",
    "bt": f"{METAMODELS}behaviour/behaviour-tree#",
    "env": f"{METAMODELS}environment#",
    "agn": f"{METAMODELS}agent#",
    "obs": f"{METAMODELS}observation#",
    "exec": f"{METAMODELS}execution-context#",
    "py": f"{METAMODELS}languages/python#",
    "ros": "https://index.ros.org/p/",
    "rbw": WORKBENCH,
    "earl": "http://www.w3.org/ns/earl#",
    "prov": "http://www.w3.org/ns/prov#",
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}
"""The namespaces of CURIEs such as ``bdd:has-clause``."""
