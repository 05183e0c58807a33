"""Contacts that clauses name as targets are left to their verdicts; all others are listed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from robbdd_tools.catalog.api import Region
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.judging.unnamed_contacts import unnamed_contacts
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.trace import Trace

REGIONS = {"e:table_ws": (("e:table", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),)}


def contact(agent: str, other: str) -> Contact:
    return Contact(agent, "", other, 1.0, 20.0, 1.1, 0.5)


CONTACTS = (contact("e:arm", "e:table"), contact("e:other", "e:table"), contact("e:arm", "floor"))
TRACE = replace(Trace((), np.zeros(0), np.zeros((0, 0, 3)), np.zeros((0, 0, 4))), contacts=CONTACTS)


def others(*sentences: str) -> list[tuple[str, str]]:
    found = unnamed_contacts(map(read_clause, sentences), TRACE, REGIONS)
    return [(one.agent, one.other) for one in found]


def test_without_clauses_every_contact_is_listed() -> None:
    assert others() == [("e:arm", "e:table"), ("e:other", "e:table"), ("e:arm", "floor")]


def test_a_target_is_left_out_for_the_agent_of_its_clause() -> None:
    named = '"e:arm" does not collide "{}" from "e:start" until "e:end"'
    for target in ("e:table", "e:table_ws"):
        assert others(named.format(target)) == [("e:other", "e:table"), ("e:arm", "floor")]


def test_an_undeclared_moving_part_belongs_to_the_target() -> None:
    trace = replace(TRACE, contacts=(contact("e:arm", "e:table/drawer"), contact("e:arm", "e:bin")))
    clause = read_clause('"e:arm" does not collide "e:table" from "e:start" until "e:end"')
    assert [one.other for one in unnamed_contacts([clause], trace, REGIONS)] == ["e:bin"]


def test_other_clauses_name_no_target() -> None:
    assert len(others('"e:arm" does not drop "e:table" from "e:start" until "e:end"')) == 3
