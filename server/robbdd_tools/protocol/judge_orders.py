"""Orders to judge edited clauses on stored traces, without simulating. Each order is one line of JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from robbdd_tools.base.plain import from_plain
from robbdd_tools.protocol.manifest_file import read_scenario, scenario_text
from robbdd_tools.protocol.specs import ExecutionSpec, ScenarioSpec, SceneSpec


@dataclass(frozen=True, slots=True)
class StoredTrace:
    """A stored execution: its number in the order's messages, the path of its trace, and its seed."""

    index: int
    path: str
    seed: int


@dataclass(frozen=True, slots=True)
class JudgeOrder:
    """The order to judge the clauses of an edited scenario on stored traces of the scenario.

    - ``spec``: the edited scenario, with only the clauses to judge. Its scene, its instance and its tree are not sent.
    - ``recorded``: the events of the stored executions with their emitters, as in ``ScenarioSpec.events``.
    - ``traces``: the executions. They differ only in their seeds.

    An order without clauses only loads the traces.
    """

    spec: ScenarioSpec
    recorded: Mapping[str, str]
    traces: tuple[StoredTrace, ...]


def encode_order(order: JudgeOrder) -> str:
    """Return an order as one line of JSON, without the line break."""
    execution = None if order.spec.execution is None else replace(order.spec.execution, scene=None)
    spec = replace(order.spec, scene=SceneSpec(), execution=execution, tree=None, chosen_instance=None)
    head = {
        "execution": None if execution is None else asdict(execution),
        "recorded": dict(order.recorded),
        "traces": [asdict(trace) for trace in order.traces],
    }
    return f'{json.dumps(head)[:-1]}, "spec": {scenario_text(spec)}}}'


def decode_order(line: str) -> JudgeOrder:
    """Return the order that a line contains. Raises ``ValueError``, ``KeyError`` or ``TypeError``."""
    fields: dict[str, Any] = json.loads(line)
    stated = fields["execution"]
    execution = None if stated is None else from_plain(ExecutionSpec, stated)
    spec = read_scenario(fields["spec"], {} if execution is None else {execution.iri: execution}, {}, {})
    traces = tuple(from_plain(StoredTrace, trace) for trace in fields["traces"])
    return JudgeOrder(spec, dict(fields["recorded"]), traces)
