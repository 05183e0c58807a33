"""``not-simulated``: a ROS action, topic or listener is not available in simulation.

The severity is information, because the model may be meant for a robot. Clauses that depend on it stay unknown in
simulation.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "not-simulated"
_CATALOG = 'catalog "pick-place"'
_GROUND_TRUTH = "simulation ground truth update-rate: 100 Hz"
WITHOUT_MESSAGES = (
    "the clauses of policies that use this provider are unknown; "
    "write 'simulation ground truth update-rate: 50 Hz' instead"
)
"""The effect of a provider of ROS messages in a simulation, and its replacement."""
WITHOUT_TOPIC = "the clause stays unknown if an execution uses this policy"
"""The effect of a ROS topic with verdicts in a simulation."""


def not_simulated(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report every element that a simulation cannot provide, and offer the simulated replacement as a quick fix."""
    uri = file.document.uri
    for placed in file.of(tree.Implementation, tree.Provider, tree.Policy):
        found = _ros(placed.declaration.tree)
        if found is None or placed.declaration.faults:
            continue
        node, what, effect, instead = found
        fixes: tuple[Fix, ...] = ()
        if instead:
            fixes = (Fix(f"Write '{instead}' instead", (Edit(uri, node.span.shifted(placed.offset), instead),)),)
        message = f"a simulation has no {what}: {effect}"
        yield Diagnostic(uri, node.span.shifted(placed.offset), Severity.INFORMATION, CODE, message, fixes=fixes)


def without_action(implementation: str) -> str:
    """Return the effect of a ROS action in a simulation, and its replacement."""
    simulated = f"write '{_CATALOG}', or run with --bhv {implementation}=pick-place"
    return f"clauses stay unknown; to simulate it, {simulated}"


def _ros(root: tree.ChunkTree | None) -> tuple[tree.Node, str, str, str] | None:
    """Return the ROS part of a declaration, its name, its effect in a simulation, and a replacement."""
    match root:
        case tree.Implementation(source=tree.RosAction() as source):
            return source, "ROS action", without_action(root.name.text), _CATALOG
        case tree.Provider(source=tree.RosTopic() | tree.Transforms() | tree.SimulatedStates() as source):
            return source, "ROS messages", WITHOUT_MESSAGES, _GROUND_TRUTH
        case tree.Policy(rule=tree.TrinaryTopic() as rule):
            return rule, "ROS topic", WITHOUT_TOPIC, ""
        case _:
            return None
