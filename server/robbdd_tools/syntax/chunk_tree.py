"""The types of the trees of whole declarations."""

from __future__ import annotations

from robbdd_tools.syntax.bdd_tree import BehaviourTree, ConstantSet, Event, Requirement, Story, Task, Template, Variant
from robbdd_tools.syntax.bddx_tree import Execution, Implementation, Observation, Policy, Provider, RobotLog
from robbdd_tools.syntax.kinematics_tree import KinematicTree, TreeInstance
from robbdd_tools.syntax.predicate_tree import NamedPredicate
from robbdd_tools.syntax.scene_tree import Composition, ElementSet, Import, Namespace, Scene, SimilarSet
from robbdd_tools.syntax.scenex_tree import Distribution, SceneInstance

DeclarationTree = (
    Import
    | Namespace
    | ElementSet
    | SimilarSet
    | Composition
    | Scene
    | Event
    | Task
    | Requirement
    | NamedPredicate
    | BehaviourTree
    | ConstantSet
    | Template
    | Story
    | Distribution
    | KinematicTree
    | TreeInstance
    | SceneInstance
    | Implementation
    | Provider
    | Observation
    | Policy
    | RobotLog
    | Execution
)
ChunkTree = DeclarationTree | Variant
"""The tree of a ``Declaration``; a scenario parsed by itself is one, too."""
