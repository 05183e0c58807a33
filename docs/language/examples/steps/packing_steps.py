"""Judges the free text of packing.bdd: a clause holds if its function returns; a failed assertion violates it."""

from behave import register_type, then
from behave.runner import Context
from parse import with_pattern

APPROVED = ("red-part", "by-table")
"""The scenarios with an approved packing plan."""


@with_pattern(r'(?:[^"\\]|\\.)*')
def _quoted(text: str) -> str:
    """Text between double quotes, backslashes included."""
    return text


register_type(Quoted=_quoted)


@then('the packing plan is approved after event "{event:Quoted}"')
def plan_is_approved(context: Context, event: str) -> None:
    """Hold if the scenario is on the list."""
    name = context.scenario.name
    assert any(one in name for one in APPROVED), f"{name} has no approved plan after {event}"


@then('{thing} is labelled {colour} after event "{event:Quoted}"')
def part_is_labelled(_: Context, thing: str, colour: str, event: str) -> None:
    """Hold if the name of the part ends with its label."""
    assert thing.strip('"').endswith(colour.strip('"')), f"{thing} is not labelled {colour} after {event}"
