"""The vocabulary of the graph, with the published namespaces and the namespaces of RobBDD.

Code writes terms as CURIEs (``bdd:has-clause``) with the prefixes of ``catalog/term_prefixes``, even if the user's file
has other prefixes.
"""

from __future__ import annotations

from functools import cache

from robbdd_tools.catalog.term_prefixes import PREFIXES

SHAPES = "https://robbdd.org/metamodels/shapes#"
"""Namespace of our SHACL shapes. The local name of a shape is its diagnostic code without ``shacl-``."""

TIME_TYPES = {
    "before": "time:BeforeEventConstraint",
    "after": "time:AfterEventConstraint",
    "during": "time:DuringEventsConstraint",
}
QUANTITY = "https://w3id.org/cdt/ucum"
"""Datatype of a number with a unit (Custom Datatypes, https://w3id.org/cdt/)."""
SOME_TIME = "rbw:AtSomeTime"
"""Class of time constraints under which a clause must hold at some time in the window instead of throughout."""
OCCURRENCE = "rbw:occurrence"
HORIZON_VARIABLE = "rbw:horizon-variable"
EVENT_LIST = "rbw:defined-events"
"""Property: the list of the events that a template defines by conditions, in written order."""
TOGETHER = "rbw:together-with"
"""Property: the earlier behaviour of the same When that is executed at the same time as a behaviour."""
REQUIREMENT = "rbw:Requirement"
VERIFIES = "rbw:verifies"
"""Property: the requirements that a story, a scenario, a template or a clause verifies."""
FURTHER_BEHAVIOUR = "rbw:further-behaviour"
"""Property: the behaviours of a scenario after the first one."""
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
"""Class of clauses and conditions whose predicate the model itself defines."""
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
