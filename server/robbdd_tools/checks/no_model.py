"""``no-model``: neither the catalog nor a ``.scenex`` has a model for an object or agent of a scene.

A run cannot judge a scenario that uses the element. Other scenarios leave the element out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import listed
from robbdd_tools.checks.model_name import parts_of
from robbdd_tools.checks.scene_use import used_elements
from robbdd_tools.names.elements import Element, Site, elements_of, simulated_members
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "no-model"
MAX_LISTED = 8
Key = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Gap:
    """Elements without a model that are reported at one place, which is a name or an entry of the scene."""

    scene: Site
    span: Span
    elements: tuple[Element, ...]


def no_model(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report elements without a model. If a scenario uses one of them, the report is a warning."""
    for placed in file.of(tree.Scene):
        scene = Site(snapshot, file, placed)
        gaps = gaps_of(scene)
        if gaps:
            used = used_elements(scene)
            every = {element.key for gap in gaps for element in gap.elements}
            needed = every if used is None else every & used
            for keys, severity in ((needed, Severity.WARNING), (every - needed, Severity.INFORMATION)):
                yield from _findings([gap for gap in gaps if _keys(gap) & keys], keys, severity)


def gaps_of(scene: Site) -> list[Gap]:
    """Return the elements of a scene that have no model. If a model of the whole scene may contain them, none."""
    if not isinstance(scene.tree, tree.Scene):
        return []
    unfit = [element for element in sorted(simulated_members(scene), key=lambda one: one.key) if not _fits(element)]
    if not unfit:
        return []
    found: dict[Span, list[Element]] = {}
    for element in not_modelled(unfit, list(scene_instances(scene))):
        found.setdefault(place_of(scene, element), []).append(element)
    return [Gap(scene, span, tuple(found[span])) for span in sorted(found)]


def not_modelled(elements: Iterable[Element], instances: Sequence[Site]) -> list[Element]:
    """Return the elements that no executable scene gives a model; none if a model of a whole scene may do so."""
    if any(_may_have_all(instance) for instance in instances):
        return []
    modelled = frozenset[Key]().union(*map(_modelled, instances))
    bodies = frozenset[str]().union(*map(_bodies, instances))
    return [element for element in elements if element.key not in modelled and _local(element) not in bodies]


def scene_instances(scene: Site) -> Iterator[Site]:
    """Yield the loaded scene instances (executable scenes) of a scene."""
    root, snapshot = scene.tree, scene.snapshot
    assert isinstance(root, tree.Scene)
    for uri in _scenex_files(snapshot):
        file = snapshot.file(uri)
        for placed in file.declarations if file is not None else ():
            instance = placed.declaration.tree
            if file is not None and isinstance(instance, tree.SceneInstance):
                target = placed.targets.get(instance.scene)
                if target is not None and (target.uri, target.symbol.path) == (scene.uri, root.name.text):
                    yield Site(snapshot, file, placed)


@kept_with_key
def _scenex_files(snapshot: Snapshot) -> tuple[str, ...]:
    return tuple(sorted(uri for uri in snapshot.sources if language_of(uri) == "scenex"))


def _fits(element: Element) -> bool:
    *sets, name = element.name.split(".")
    match element.kind:
        case "object":
            return load_catalog().object_for(name, sets) is not None
        case "agent":
            catalog = load_catalog()
            return (catalog.robot_for(name, sets) or catalog.bystander_for(name, sets)) is not None
        case _:
            return True


def _may_have_all(instance: Site) -> bool:
    """Return whether an executable scene loads its objects from a file whose bodies are known only in a run."""
    root = instance.tree
    return isinstance(root, tree.SceneInstance) and any(isinstance(entry, tree.Model) for entry in root.entries)


def _modelled(instance: Site) -> frozenset[Key]:
    found: set[Key] = set()
    for node in walk(instance.tree) if instance.tree is not None else ():
        if not isinstance(node, tree.Modelled) or not any(isinstance(entry, tree.Model) for entry in node.entries):
            continue
        target = instance.target(node.reference)
        if target is None:
            continue
        if target.kind in (SymbolKind.OBJECT, SymbolKind.AGENT):
            found.add((target.uri, target.symbol.path))
        else:
            found.update(element.key for element in elements_of(instance.follow(node.reference)) or ())
    return frozenset(found)


def _bodies(instance: Site) -> frozenset[str]:
    """Return the names of the bodies in the files of a scene instance: a moving part of a model is an object, too."""
    folder = uri_to_path(instance.uri)
    models = [node for node in walk(instance.tree) if isinstance(node, tree.Model)] if instance.tree is not None else []
    files = [] if folder is None else [parts_of(model, folder.parent) for model in models]
    return frozenset(part.name for file in files if file is not None for part in file.names("body"))


def place_of(scene: Site, element: Element) -> Span:
    """Return the place of an element's name, or the scene entry that includes it if the name is in another file."""
    root = scene.tree
    assert isinstance(root, tree.Scene)
    uri, path = element.key
    if uri == scene.uri and path in scene.file.definitions:
        return scene.file.definitions[path].span
    for entry in root.entries:
        inner = scene.follow(entry.reference)
        held = elements_of(inner) or ()
        if element in held or (inner is not None and entry.reference.role == "Composition" and _names(inner, element)):
            return scene.span(entry.reference)
    return scene.span(root.name)


def _names(composition: Site, element: Element) -> bool:
    targets = (composition.target(reference.ref) for reference in composition.placed.declaration.references)
    return any(target is not None and (target.uri, target.symbol.path) == element.key for target in targets)


def _keys(gap: Gap) -> set[Key]:
    return {element.key for element in gap.elements}


def _findings(gaps: list[Gap], keys: set[Key], severity: Severity) -> Iterator[Diagnostic]:
    named = {gap.span: [_local(element) for element in gap.elements if element.key in keys] for gap in gaps}
    for gap in gaps:
        kinds = {element.kind for element in gap.elements}
        message = without_model(named[gap.span], kinds, is_used=severity is Severity.WARNING)
        uri = gap.scene.uri
        related = tuple(Related(uri, other.span, "no model fits this name") for other in gaps if other.span != gap.span)
        yield Diagnostic(uri, gap.span, severity, CODE, message, related)


def without_model(own: list[str], kinds: Set[str], *, is_used: bool) -> str:
    """Return the message on elements of some kinds without a model."""
    message = f"no model fits the name {listed(own)}"
    if not is_used:
        return f"{message}: no scenario uses it, so runs omit it"
    message += f": it has none of the catalog's words ({_words(kinds)}); give it another name, or a model in a .scenex"
    return f"{message} that --scenex or an execution of a .bddx names"


def _words(kinds: Set[str]) -> str:
    """Return the first words by which the catalog's models of some kinds are found, of each model one."""
    catalog = load_catalog()
    models = [*(catalog.objects.values() if "object" in kinds else ())]
    robots = [*(catalog.agents if "agent" in kinds else ())]
    words = sorted({model.prefixes[0] for model in (*models, *robots) if model.prefixes})
    return f"{', '.join(words[:MAX_LISTED])}{', …' if len(words) > MAX_LISTED else ''}"


def _local(element: Element) -> str:
    return element.name.rpartition(".")[2]
