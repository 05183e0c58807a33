"""The vocabulary of the graph, with published namespaces and those of RobBDD.

Code writes terms as CURIEs (``bdd:has-clause``) with the prefixes of ``catalog/term_prefixes``, whatever prefixes the
user's file has.
"""

from __future__ import annotations

from functools import cache

from robbdd_tools.catalog.term_prefixes import PREFIXES

SHAPES = "https://robbdd.org/metamodels/shapes#"
"""Namespace of our SHACL shapes; a shape's local name is the diagnostic code without ``shacl-``."""

TIME_TYPES = {
    "before": "time:BeforeEventConstraint",
    "after": "time:AfterEventConstraint",
    "during": "time:DuringEventsConstraint",
}
QUANTITY = "https://w3id.org/cdt/ucum"
"""Datatype of a number with a unit (Custom Datatypes, https://w3id.org/cdt/)."""
SOME_TIME = "rbw:AtSomeTime"
"""Class of a time constraint that must hold at some time in its window instead of throughout."""
OCCURRENCE = "rbw:occurrence"
HORIZON_VARIABLE = "rbw:horizon-variable"
EVENT_LIST = "rbw:defined-events"
"""The events that a template defines by conditions, in written order."""
TOGETHER = "rbw:together-with"
"""The behaviour in the same When, written before it, at the same time as which a behaviour is executed."""
REQUIREMENT = "rbw:Requirement"
VERIFIES = "rbw:verifies"
"""The requirements that a story, a scenario, a template or a clause verifies."""
FURTHER_BEHAVIOUR = "rbw:further-behaviour"
"""The behaviours of a scenario besides the first one."""
ELEMENT_TYPES = {"object": "env:Object", "workspace": "env:Workspace", "agent": "agn:Agent"}
"""Kind of an element → its class."""
MEMBERSHIPS = {
    "object": ("bdd:SceneHasObjects", "env:has-object", "-scene-has-obj"),
    "workspace": ("bdd:SceneHasWorkspaces", "env:has-workspace", "-scene-has-ws"),
    "agent": ("bdd:SceneHasAgents", "agn:has-agent", "-scene-has-agn"),
}
"""Kind of an element → class, property and IRI suffix of the node that adds such elements to a scene."""
JUNCTIONS = {"and": "rbw:Conjunction", "or": "rbw:Disjunction", "not": "rbw:Negation"}
NAMED_USE = "rbw:NamedPredicateUse"
"""Class of a clause, or of a condition, whose predicate the model itself defines."""
STATES = {"and": "rbw:AllStates", "or": "rbw:AnyState", "not": "rbw:NegatedState"}
"""Operator in the definition of a predicate → its class."""
COMPOSITES = {"sequence": "bt:Sequence", "selector": "bt:Selector"}
"""Kind of a behaviour tree's composite → its class."""
SELECTIONS = {"combinations": "bdd:Combination", "permutations": "bdd:Permutation"}


@cache
def expand(term: str) -> str:
    """Return the IRI of a CURIE. A full IRI is returned unchanged. Raises ``KeyError`` for an unknown prefix."""
    prefix, _, local = term.partition(":")
    return term if local.startswith("//") else PREFIXES[prefix] + local
