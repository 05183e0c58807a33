"""Find the uses of variables and events in the clauses of a declaration. They are cached with the declaration."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.phrases_in_text import predicates_in_text
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.syntax.declaration import Declaration

Kinds = frozenset[str]
SECONDS: Kinds = frozenset({"number"})
SECONDS_PHRASE = "… seconds"
ELEMENTS: Kinds = frozenset({"object", "workspace", "agent"})
ANYTHING: Kinds = ELEMENTS | {"number", "quantity", "string"}
_SLOTS: Mapping[Kind, Kinds] = {
    Kind.OBJECT: frozenset({"object"}),
    Kind.OBJECT_SET: frozenset({"object"}),
    Kind.WORKSPACE: frozenset({"workspace"}),
    Kind.WORKSPACE_SET: frozenset({"workspace"}),
    Kind.AGENT: frozenset({"agent"}),
    Kind.QUANTITY: frozenset({"quantity"}),
    Kind.ANY: ELEMENTS,
}


@dataclass(frozen=True, slots=True)
class Bound:
    """A variable that a quantifier introduces."""

    variable: tree.Name
    in_set: tree.Ref


@dataclass(frozen=True, slots=True)
class Use:
    """A variable in a slot of a phrase. ``kinds`` are the kinds that the slot accepts.

    ``bound`` is the quantifier that introduces the variable, if any.
    """

    ref: tree.Ref
    kinds: Kinds
    phrase: str
    bound: Bound | None


@dataclass(frozen=True, slots=True)
class Clauses:
    """The clauses of one template or variant.

    - ``path``: its qualified name; ``""`` if unknown.
    - ``phrases``: the phrases in text order.
    - ``once``: the durations outside of every ``for all``. The events of all other durations occur in each iteration.
    """

    node: tree.Template | tree.Variant
    path: str
    phrases: tuple[tree.PhraseUse, ...]
    uses: tuple[Use, ...]
    bounds: tuple[Bound, ...]
    durations: tuple[tree.During, ...]
    once: tuple[tree.During, ...]


@kept_with_key
def clauses_of(declaration: Declaration) -> tuple[Clauses, ...]:
    """Return the clauses of a template, or of each variant of a story; empty for any other declaration."""
    match declaration.tree:
        case tree.Template() as template:
            return (_collected(template, template.name.text, (template.duration, *template.events, template.body)),)
        case tree.Story() as story:
            return tuple(_of_variant(variant, f"{story.name.text}.{variant.name.text}") for variant in story.variants)
        case tree.Variant() as variant:
            return (_of_variant(variant, declaration.symbols[0].path if declaration.symbols else ""),)
        case _:
            return ()


def _of_variant(variant: tree.Variant, path: str) -> Clauses:
    return _collected(variant, path, (variant.given, variant.then))


def _collected(node: tree.Template | tree.Variant, path: str, parts: tuple[tree.Node | None, ...]) -> Clauses:
    collector = _Collector()
    for part in parts:
        collector.visit(part, {}, repeated=False)
    uses = tuple(sorted(collector.uses, key=lambda use: use.ref.span))
    phrases = tuple(sorted(collector.phrases, key=lambda phrase: phrase.span))
    durations, once = tuple(collector.durations), tuple(collector.once)
    return Clauses(node, path, phrases, uses, tuple(collector.bounds), durations, once)


@dataclass(slots=True)
class _Collector:
    phrases: list[tree.PhraseUse] = field(default_factory=list[tree.PhraseUse])
    uses: list[Use] = field(default_factory=list[Use])
    bounds: list[Bound] = field(default_factory=list[Bound])
    durations: list[tree.During] = field(default_factory=list[tree.During])
    once: list[tree.During] = field(default_factory=list[tree.During])

    def visit(self, node: tree.Node | None, bound: Mapping[str, Bound], *, repeated: bool) -> None:
        match node:
            case tree.Body():
                for part in node.parts:
                    self.visit(part, bound, repeated=repeated)
            case tree.Part():
                behaviours = () if node.when is None else node.when.behaviours
                for part in (node.given, *behaviours, node.for_all, node.then):
                    self.visit(part, bound, repeated=repeated)
            case tree.BehaviourUse():
                self.visit(node.duration, bound, repeated=repeated)
                self._phrase(node.action, bound)
            case tree.Fluent():
                self.visit(node.time, bound, repeated=repeated)
                self._phrase(node.predicate, bound)
                for condition in node.conditions:
                    self._phrase(condition, bound)
            case tree.DefinedEvent():
                for condition in node.conditions:
                    self._phrase(condition, bound)
                if isinstance(node.seconds, tree.Ref):
                    self.uses.append(Use(node.seconds, SECONDS, SECONDS_PHRASE, None))
            case tree.TextClause():
                self.visit(node.time, bound, repeated=repeated)
            case tree.Before(horizon=tree.Ref() as seconds) | tree.After(horizon=tree.Ref() as seconds):
                self.uses.append(Use(seconds, SECONDS, SECONDS_PHRASE, bound.get(seconds.path)))
            case tree.During():
                self.durations.append(node)
                if not repeated:
                    self.once.append(node)
            case tree.Negation():
                self.visit(node.operand, bound, repeated=repeated)
            case tree.Conjunction() | tree.Disjunction():
                for operand in node.operands:
                    self.visit(operand, bound, repeated=repeated)
            case tree.ForAll() | tree.Exists():
                self.bounds.append(Bound(node.variable, node.in_set))
                inner = {**bound, node.variable.text: self.bounds[-1]}
                self.visit(node.body, inner, repeated=repeated or isinstance(node, tree.ForAll))
            case _:
                pass

    def _phrase(self, node: tree.PhraseUse | tree.TextPredicate | tree.NamedUse, bound: Mapping[str, Bound]) -> None:
        if isinstance(node, tree.TextPredicate):
            refs = [(one.value, ANYTHING) for one in node.arguments if isinstance(one.value, tree.Ref)]
            said = predicates_in_text(node.template.value, [one.name.text for one in node.arguments])
            phrase = said[0][0].phrase if said else "pred(…)"
        elif isinstance(node, tree.NamedUse):
            # The kinds of its parameters depend on another declaration.
            refs = [(value, ANYTHING) for value in node.values if isinstance(value, tree.Ref)]
            phrase = node.predicate.path
        else:
            self.phrases.append(node)
            slots, phrase = slot_kinds(node.word), phrase_words(node.word)
            refs = [(value, slots[name]) for name, value in node.arguments if isinstance(value, tree.Ref)]
        self.uses += [Use(ref, kinds, phrase, bound.get(ref.path)) for ref, kinds in refs]


@cache
def slot_kinds(word: str) -> Mapping[str, Kinds]:
    """Return the kinds of each slot of a catalog word."""
    catalog = load_catalog()
    known = catalog.predicates.get(word) or catalog.behaviours[word]
    return {slot.name: _SLOTS.get(slot.kind, ANYTHING) for slot in known.slots}


@cache
def dimension_of_phrase(phrase: str) -> str:
    """Return the dimension of the quantity in a predicate's phrase; empty if it has none."""
    words = (word for word in load_catalog().predicates.values() if word.phrase == phrase)
    return next((slot.dimension for word in words for slot in word.slots if slot.dimension), "")


@cache
def phrase_words(word: str) -> str:
    """Return the phrase of a catalog word."""
    catalog = load_catalog()
    return (catalog.predicates.get(word) or catalog.behaviours[word]).phrase
