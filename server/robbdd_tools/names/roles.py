"""The kinds of target that each reference rule of the grammar accepts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from robbdd_tools.syntax.declaration import SymbolKind

VARIABLES = (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)
_ELEMENTS = (SymbolKind.OBJECT, SymbolKind.WORKSPACE, SymbolKind.AGENT)
_ELEMENT_SETS = (SymbolKind.OBJECT_SET, SymbolKind.WORKSPACE_SET, SymbolKind.AGENT_SET)
ROLE_KINDS: Mapping[str, tuple[SymbolKind, ...]] = {
    "Namespace": (SymbolKind.NAMESPACE,),
    "Event": (SymbolKind.EVENT,),
    "Task": (SymbolKind.TASK,),
    "Requirement": (SymbolKind.REQUIREMENT,),
    "Predicate": (SymbolKind.PREDICATE,),
    "Template": (SymbolKind.TEMPLATE,),
    "Variable": (*VARIABLES, SymbolKind.PARAMETER),
    "Term": (*VARIABLES, SymbolKind.PARAMETER, *_ELEMENTS),
    "Scene": (SymbolKind.SCENE,),
    "Composition": (SymbolKind.COMPOSITION,),
    "Object": (SymbolKind.OBJECT,),
    "Workspace": (SymbolKind.WORKSPACE,),
    "Element": _ELEMENTS,
    "ObjectSet": (SymbolKind.OBJECT_SET,),
    "WorkspaceSet": (SymbolKind.WORKSPACE_SET,),
    "AgentSet": (SymbolKind.AGENT_SET,),
    "ConstantSet": (SymbolKind.CONSTANT_SET,),
    "AnySet": (*_ELEMENT_SETS, SymbolKind.CONSTANT_SET, SymbolKind.SET_VARIABLE),
    "Agent": (SymbolKind.AGENT,),
    "TreeNode": (SymbolKind.TREE_NODE,),
    "Distribution": (SymbolKind.DISTRIBUTION,),
    "Tree": (SymbolKind.TREE, SymbolKind.TREE_INSTANCE),
    "TreeTemplate": (SymbolKind.TREE_TEMPLATE,),
    "Frame": (SymbolKind.FRAME,),
    "Body": (SymbolKind.BODY,),
    "Joint": (SymbolKind.JOINT,),
    "SceneInstance": (SymbolKind.SCENE_INSTANCE,),
    "Variant": (SymbolKind.VARIANT,),
    "Fluent": (SymbolKind.FLUENT,),
    "Implementation": (SymbolKind.IMPLEMENTATION,),
    "Provider": (SymbolKind.PROVIDER,),
    "Observation": (SymbolKind.OBSERVATION,),
    "Policy": (SymbolKind.POLICY,),
    "Log": (SymbolKind.ROBOT_LOG,),
}

_SCENE_KINDS = {*_ELEMENTS, *_ELEMENT_SETS, SymbolKind.COMPOSITION, SymbolKind.SCENE, SymbolKind.NAMESPACE}
_TREE_KINDS = {
    SymbolKind.NAMESPACE,
    SymbolKind.DISTRIBUTION,
    SymbolKind.TREE_TEMPLATE,
    SymbolKind.TREE,
    SymbolKind.TREE_INSTANCE,
    SymbolKind.BODY,
    SymbolKind.FRAME,
    SymbolKind.POSE,
    SymbolKind.JOINT,
}
_INSTANCE_KINDS = {SymbolKind.SCENE_INSTANCE, SymbolKind.GRAPH, SymbolKind.MODEL, SymbolKind.SENSOR}
_DECLARED_BEHIND = {
    "scene": _SCENE_KINDS,
    "ktree": _TREE_KINDS,
    "scenex": _SCENE_KINDS | _TREE_KINDS | _INSTANCE_KINDS,
    "bdd": set(SymbolKind),
    "bddx": set(SymbolKind),
}


def may_declare(language: str, kinds: Iterable[SymbolKind]) -> bool:
    """Return whether a file of a language, or a file that it can import, may declare a name of some kinds."""
    return not _DECLARED_BEHIND.get(language, set()).isdisjoint(kinds)
