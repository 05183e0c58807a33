"""Semantic rules beyond syntax, names and shapes. There is one file for each diagnostic code.

A rule checks either one declaration with its references, or a whole file. A rule on declarations checks a declaration
again only when the declaration or one of its references has changed. A rule on files may spend only a few operations on
each declaration.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.checks.behaviour_tree import behaviour_tree
from robbdd_tools.checks.catalog_entry import catalog_entry
from robbdd_tools.checks.catalog_models import catalog_models
from robbdd_tools.checks.catalog_phrase import catalog_phrase
from robbdd_tools.checks.contradictory_order import contradictory_order
from robbdd_tools.checks.cyclic_import import cyclic_import
from robbdd_tools.checks.defined_event import defined_event
from robbdd_tools.checks.distribution import distribution
from robbdd_tools.checks.duplicate_iri import duplicate_iri
from robbdd_tools.checks.emission import emission
from robbdd_tools.checks.empty_duration import empty_duration
from robbdd_tools.checks.empty_set import empty_set
from robbdd_tools.checks.execution_fit import execution_fit
from robbdd_tools.checks.external_system import external_system
from robbdd_tools.checks.foreign_variable import foreign_variable
from robbdd_tools.checks.hidden_variable import hidden_variable
from robbdd_tools.checks.joint_ends import joint_ends
from robbdd_tools.checks.many_scenarios import many_scenarios
from robbdd_tools.checks.memo import Kept
from robbdd_tools.checks.missing_value import missing_value
from robbdd_tools.checks.model_file import model_file
from robbdd_tools.checks.model_name import model_name
from robbdd_tools.checks.named_predicate import named_predicate
from robbdd_tools.checks.namespace_iri import namespace_iri
from robbdd_tools.checks.no_correct_place import no_correct_place
from robbdd_tools.checks.no_emitter import no_emitter
from robbdd_tools.checks.no_evaluator import no_evaluator
from robbdd_tools.checks.no_model import no_model
from robbdd_tools.checks.no_region import no_region
from robbdd_tools.checks.no_room import no_room
from robbdd_tools.checks.no_scenario import no_scenario
from robbdd_tools.checks.not_in_scene import not_in_scene
from robbdd_tools.checks.not_simulated import not_simulated
from robbdd_tools.checks.number_range import number_range
from robbdd_tools.checks.pose import pose
from robbdd_tools.checks.property_condition import property_condition
from robbdd_tools.checks.property_value import property_value
from robbdd_tools.checks.published_form import published_form
from robbdd_tools.checks.python_source import python_source
from robbdd_tools.checks.quantity import quantity
from robbdd_tools.checks.repeated_value import repeated_value
from robbdd_tools.checks.row_width import row_width
from robbdd_tools.checks.same_space import same_space
from robbdd_tools.checks.selection_size import selection_size
from robbdd_tools.checks.setting import setting
from robbdd_tools.checks.several_places import several_places
from robbdd_tools.checks.simultaneous_agent import simultaneous_agent
from robbdd_tools.checks.single_element import single_element
from robbdd_tools.checks.table_column import table_column
from robbdd_tools.checks.type_conflict import type_conflict
from robbdd_tools.checks.unused_event import unused_event
from robbdd_tools.checks.unused_import import unused_import
from robbdd_tools.checks.unused_predicate import unused_predicate
from robbdd_tools.checks.unused_set import unused_set
from robbdd_tools.checks.unused_task import unused_task
from robbdd_tools.checks.unused_variable import unused_variable
from robbdd_tools.checks.unverified_requirement import unverified_requirement
from robbdd_tools.names.anchors import Anchored, Anchors
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.project import Snapshot

DECLARATION_RULES = (
    contradictory_order,
    defined_event,
    distribution,
    emission,
    empty_duration,
    empty_set,
    foreign_variable,
    hidden_variable,
    joint_ends,
    many_scenarios,
    missing_value,
    no_emitter,
    no_region,
    not_in_scene,
    number_range,
    pose,
    property_value,
    quantity,
    repeated_value,
    row_width,
    selection_size,
    setting,
    simultaneous_agent,
    single_element,
    type_conflict,
)
FILE_RULES = (
    behaviour_tree,
    catalog_entry,
    cyclic_import,
    catalog_models,
    catalog_phrase,
    duplicate_iri,
    execution_fit,
    model_file,
    model_name,
    named_predicate,
    namespace_iri,
    no_correct_place,
    no_evaluator,
    no_model,
    no_room,
    no_scenario,
    not_simulated,
    external_system,
    property_condition,
    published_form,
    python_source,
    same_space,
    several_places,
    table_column,
    unused_event,
    unused_import,
    unused_predicate,
    unused_set,
    unused_task,
    unused_variable,
    unverified_requirement,
)
_RULED: frozenset[type[object]] = frozenset(
    {
        tree.ElementSet,
        tree.SimilarSet,
        tree.ConstantSet,
        tree.Template,
        tree.Story,
        tree.Variant,
        tree.Distribution,
        tree.KinematicTree,
        tree.SceneInstance,
        tree.Provider,
        tree.Policy,
        tree.Execution,
    }
)
"""Kinds of declarations that rules check."""


def _findings(site: Site) -> tuple[Anchored, ...]:
    found: list[Diagnostic] = []
    for rule in DECLARATION_RULES:
        checkpoint()
        found += rule(site)
    anchors = Anchors(site.snapshot)
    return tuple(anchors.loosened(diagnostic, site.uri, site.placed) for diagnostic in found)


KEPT = Kept(_RULED, _findings)


def run_checks(snapshot: Snapshot, uri: str) -> list[Diagnostic]:
    """Return the diagnostics of every rule for one file."""
    file = snapshot.file(uri)
    if file is None:
        return []
    found: list[Diagnostic] = []
    for rule in FILE_RULES:
        checkpoint()
        found += rule(snapshot, file)
    anchors = Anchors(snapshot)
    for placed, kept in KEPT.of(snapshot, file):
        if kept:
            found += [anchors.fixed(finding, uri, placed) for finding in kept]
    return found
