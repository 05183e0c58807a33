"""Convert the parser's objects to our frozen trees."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.parsed import RawNode
from robbdd_tools.syntax.phrases import word_of_rule
from robbdd_tools.syntax.published import complete_template, complete_variant, unnamed_at
from robbdd_tools.syntax.scene_tree import field_names

_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}
_KINDS = {"obj": "object", "ws": "workspace", "agn": "agent"}


def convert(raw: RawNode, text: str) -> Any:
    """Convert a parser's object to a tree node. ``text`` is the parsed text, which repairs may have extended."""
    checkpoint()
    rule = type(raw).__name__
    span = Span(min(raw._tx_position, len(text)), min(raw._tx_position_end, len(text)))
    if rule.endswith("Ref"):
        start = text.find(raw.path, span.start)
        start, end = (start, start + len(raw.path)) if start >= 0 else (span.end, span.end)
        return tree.Ref(Span(start, end), rule.removesuffix("Ref"), raw.path)
    word = word_of_rule(rule)
    if word is not None:
        return tree.PhraseUse(span, word, _phrase_arguments(raw, text))
    special = _SPECIAL.get(rule)
    if special is not None:
        return special(raw, span, text)
    return _by_fields(getattr(tree, rule), raw, span, text)


def _by_fields(node: type[tree.Node], raw: RawNode, span: Span, text: str, **given: Any) -> Any:
    values = {
        name: _value(getattr(raw, name), text) for name in field_names(node) if name != "span" and name not in given
    }
    return node(span=span, **values, **given)


def _value(value: Any, text: str) -> Any:
    if isinstance(value, list):
        entries = cast(list[Any], value)
        return tuple(_value(entry, text) for entry in entries)
    if value is None or isinstance(value, str | bool):
        return value
    return convert(value, text)


def _phrase_arguments(raw: RawNode, text: str) -> tuple[tuple[str, tree.Argument], ...]:
    """Return the slots of a phrase with their values, in written order."""
    fields_of_raw = cast(dict[str, Any], vars(raw))
    slots: list[tuple[str, tree.Argument]] = [
        (name, convert(value, text)) for name, value in fields_of_raw.items() if name[0] != "_" and name != "parent"
    ]
    return tuple(sorted(slots, key=lambda slot: slot[1].span))


def _text(raw: RawNode, span: Span, _: str) -> tree.Text:
    written = re.sub(r"\r\n?", "\n", raw.raw[1:-1])  # A string's value does not depend on the line endings of its file.
    value = re.sub(r"\\(.)", lambda match: _ESCAPES.get(match[1], match[1]), written, flags=re.DOTALL)
    return tree.Text(span, value)


def _number(raw: RawNode, span: Span, _: str) -> tree.Number:
    digits: str = raw.raw
    whole = digits.lstrip("+-").isdigit()
    return tree.Number(span, int(digits) if whole else float(digits))


def _quantity(raw: RawNode, span: Span, _: str) -> tree.Quantity:
    number = re.match(r"[-+\d.eE]+(?<![eE])", raw.raw)
    assert number is not None
    return tree.Quantity(span, f"{number[0]} {raw.raw[number.end() :].strip()}")


def _inner(field: str) -> Callable[[RawNode, Span, str], Any]:
    """Return a converter for a rule that consists of a single part with keywords around it."""
    return lambda raw, _, text: _value(getattr(raw, field), text)


def _given(node: type[tree.Node], **given: Any) -> Callable[[RawNode, Span, str], Any]:
    return lambda raw, span, text: _by_fields(node, raw, span, text, **given)


def _clauses(raw: RawNode, span: Span, text: str) -> tree.Expression:
    """Join a sequence of clauses by *and*."""
    found: tuple[tree.Expression, ...] = _value(raw.clauses, text)
    return found[0] if len(found) == 1 else tree.Conjunction(span, found)


def _bare_behaviour(raw: RawNode, span: Span, text: str) -> tree.BehaviourUse:
    duration = _value(raw.duration, text)
    return tree.BehaviourUse(span, None, unnamed_at(span), duration, convert(raw.action, text), (), None)


def _listed_assignment(raw: RawNode, span: Span, text: str) -> tree.Assignment:
    values = _value(raw.values, text)
    listed = tree.ValueList(Span(values[0].span.start, span.end), values)
    return tree.Assignment(span, convert(raw.variable, text), listed)


def _variant(raw: RawNode, span: Span, text: str) -> tree.Variant:
    variant = complete_variant(_by_fields(tree.Variant, raw, span, text))
    product = raw.variation if type(raw.variation).__name__ == "ListedProduct" else raw.variation.variation
    if not isinstance(variant.variation, tree.Product):
        return variant
    assignments = tuple(
        _qualified(assignment, variant.template.path) if type(written).__name__ == "ListedAssignment" else assignment
        for written, assignment in zip(product.assignments, variant.variation.assignments, strict=True)
    )
    return replace(variant, variation=replace(variant.variation, assignments=assignments))


def _qualified(assignment: tree.Assignment, template: str) -> tree.Assignment:
    """Qualify an unqualified variable of an assignment with the variant's template."""
    variable = assignment.variable
    if "." in variable.path:
        return assignment
    return replace(assignment, variable=replace(variable, path=f"{template}.{variable.path}"))


_SPECIAL: dict[str, Callable[[RawNode, Span, str], Any]] = {
    "Text": _text,
    "Number": _number,
    "Quantity": _quantity,
    "ObjectSet": _given(tree.ElementSet, kind="object"),
    "WorkspaceSet": _given(tree.ElementSet, kind="workspace"),
    "AgentSet": _given(tree.ElementSet, kind="agent"),
    "SimilarSet": lambda raw, span, text: _by_fields(tree.SimilarSet, raw, span, text, kind=_KINDS[raw.kind]),
    "SetVariable": _given(tree.Variable, is_set=True),
    "PlainVariable": _given(tree.Variable, is_set=False),
    **dict.fromkeys(
        ("Object", "Agent"),
        lambda raw, span, text: _by_fields(tree.Member, raw, span, text, details=_value(raw.properties, text)),
    ),
    "Workspace": _given(tree.Member),
    **dict.fromkeys(("ModuleName", "PhraseWord", "PropertyName", "ColumnName"), _given(tree.Name)),
    "Subject": _inner("parameter"),
    "Truth": lambda raw, span, _: tree.Truth(span, raw.word == "true"),
    "Word": lambda raw, span, _: tree.Text(span, raw.text),
    "Template": lambda raw, span, text: complete_template(_by_fields(tree.Template, raw, span, text)),
    "Variant": _variant,
    "Clauses": _clauses,
    **dict.fromkeys(
        ("UnnamedFluent", "BareFluent"),
        lambda raw, span, text: _by_fields(tree.Fluent, raw, span, text, name=unnamed_at(span)),
    ),
    "During": _given(tree.During, some_time=False),
    "SomeTime": _given(tree.During, some_time=True),
    "BareBehaviour": _bare_behaviour,
    "HeadedVariation": _inner("variation"),
    "ListedProduct": _given(tree.Product),
    "ListedAssignment": _listed_assignment,
    **dict.fromkeys(("ListedObject", "ListedWorkspace", "ListedAgent", "ListedPlain"), _inner("value")),
    **dict.fromkeys(
        (
            "CompositionMember",
            "ObjectMember",
            "WorkspaceMember",
            "ObjectSetLink",
            "WorkspaceSetLink",
            "AgentSetLink",
            "ConstantSetLink",
            "FittingSet",
            "TargetVariable",
            "TargetObject",
            "TargetWorkspace",
            "TargetAgent",
        ),
        lambda raw, span, text: tree.Link(
            span,
            convert(raw.reference, text),
            _value(getattr(raw, "where", None), text),
            _value(getattr(raw, "columns", None), text),
        ),
    ),
    "PropertyComparison": _given(tree.PropertyCondition),
    "PropertyFlag": lambda raw, span, text: tree.PropertyCondition(
        span, convert(raw.name, text), "not" if raw.negated else "=", None
    ),
    "SetsAssignment": lambda raw, span, text: tree.Assignment(
        span, convert(raw.variable, text), convert(raw.sets, text)
    ),
    "ValuesAssignment": lambda raw, span, text: tree.Assignment(
        span, convert(raw.variable, text), convert(raw.values, text)
    ),
    "Table": lambda raw, span, text: tree.Table(span, _value(raw.header.variables, text), _value(raw.rows, text)),
    **dict.fromkeys(("Covariance", "Deviation", "QuaternionVector"), _inner("value")),
    "EulerAngles": lambda raw, span, text: tree.EulerAngles(
        span, raw.axes or "", raw.extrinsic, convert(raw.angles, text), raw.unit or None
    ),
    **{
        f"{quantity.capitalize()}Limit": _given(tree.Limit, quantity=quantity)
        for quantity in ("position", "velocity", "acceleration", "effort")
    },
    **dict.fromkeys(
        ("ModelledObject", "ModelledObjectSet", "ModelledAgent", "ModelledAgentSet", "ModelledWorkspace"),
        _given(tree.Modelled),
    ),
    **dict.fromkeys(("BodyMapping", "TreeMapping"), _given(tree.Mapping)),
    **dict.fromkeys(("FrictionObject", "FrictionObjectSet", "FrictionAgent", "FrictionAgentSet"), _inner("reference")),
    "ForceTorque": _given(tree.Sensor, kind="force-torque"),
    "Imu": _given(tree.Sensor, kind="imu"),
    "ObservedTarget": _inner("target"),
}
