"""Probes: clauses that are measured in addition to the model's, to propose those that would notice a fault.

A probe is judged like any other clause, in executions without and with the fault. It is proposed only if its verdicts
or measured values separate the executions with the fault from those without.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.coordination import each_emitter, emitter
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import BehaviourClause, every_clause
from robbdd_tools.monitor.time import After, During
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.clauses import BehaviourCall, Fluent
from robbdd_tools.protocol.specs import PROBE, ClauseSpec
from robbdd_tools.run.report import margin, variable_word

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import Template
    from robbdd_tools.monitor.time import TimeConstraint
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.diagnostics import Place
    from robbdd_tools.workbench.plan import Plan

CLEAR = 1.1
"""A limit is proposed only if the values on both sides of it have this ratio: chance, too, separates few executions."""
AFTER, DURING, SOME_TIME, WHOLE = "after", "during", "some-time", "whole"


@dataclass(frozen=True, slots=True)
class Probe:
    """A clause to measure.

    - ``slots``: maps slots of the predicate to slots of the behaviour.
    - ``limit``: the slot of a limit, if there is one.
    - ``limit_value``: a limit (SI) so wide that it never decides; the measured value is this limit minus or plus the
      margin.
    - ``text``: the clause in the model, with placeholders in braces; ``LIMIT`` depends on the task.
    """

    predicate: str
    slots: Mapping[str, str]
    time: str
    text: str
    limit: str = ""
    limit_value: float = 0.0
    unit: str = ""
    is_upper: bool = True

    @property
    def iri(self) -> str:
        """The name of the probe among the clauses of a scenario."""
        return f"{PROBE}:{self.predicate}"

    def value(self, robustness: float) -> float:
        """Return the measured quantity for a margin."""
        return self.limit_value - robustness if self.is_upper else self.limit_value + robustness


_HELD = {"agent": "agent", "object": "object"}
PROBES = (
    Probe("located-at", {"object": "object", "workspace": "workspace"}, AFTER,
          "holds(<{object}> is located at <{workspace}>, after <{end}>)"),
    Probe("held-by", _HELD, SOME_TIME,
          "holds(<{object}> is held by <{agent}>, at some time from <{start}> until <{end}>)"),
    Probe("does-not-drop", _HELD, WHOLE,
          "holds(<{agent}> does not drop <{object}>, from <{begin}> until <{over}>)"),
    Probe("does-not-collide", {"agent": "agent", "target": "workspace"}, WHOLE,
          "holds(<{agent}> does not collide <{workspace}>, from <{begin}> until <{over}>)"),
    Probe("takes-less-than", {}, DURING, "holds(it takes less than LIMIT, from <{start}> until <{end}>)",
          "limit", 1e4, "s"),
    Probe("moves-slower-than", {"agent": "agent"}, DURING,
          "holds(<{agent}> moves slower than LIMIT, from <{start}> until <{end}>)", "limit", 1e3, "m/s"),
    Probe("is-farther-than", {"one": "agent", "other": "object"}, AFTER,
          "holds(<{agent}> is farther than LIMIT from <{object}>, after <{end}>)", "distance", 1e-4, "m",
          is_upper=False),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class ProbedTemplate:
    """A template of a plan, the place of its declaration, and the words of proposed clauses."""

    name: str
    place: Place | None
    words: tuple[tuple[str, str], ...]

    def written(self, probe: Probe) -> str:
        """Return a probe as a clause of the template, named after its predicate."""
        text = probe.text
        for name, word in self.words:
            text = text.replace(f"{{{name}}}", word)
        return f"{probe.predicate}: {text}"


def with_probes(spec: ScenarioSpec) -> ScenarioSpec:
    """Add the probes of its first behaviour to an execution's clauses. Without a behaviour, return it unchanged."""
    called = next((one for one in spec.clauses if isinstance(one.statement, BehaviourCall)), None)
    if called is None or not isinstance(called.statement, BehaviourCall):
        return spec
    times = _times(spec, called.statement)
    clauses: list[ClauseSpec] = []
    for number, probe in enumerate(PROBES, start=1):
        arguments = {slot: called.statement.arguments.get(own) for slot, own in probe.slots.items()}
        known = {slot: filler for slot, filler in arguments.items() if isinstance(filler, str)}
        if len(known) == len(arguments) and probe.time in times:
            limit = {probe.limit: f"{probe.limit_value} {probe.unit}"} if probe.limit else {}
            fluent = Fluent(load_catalog().predicates[probe.predicate], known | limit, times[probe.time], probe.iri)
            clauses.append(ClauseSpec(-number, probe.iri, probe.predicate, PROBE, "", fluent, (), called.iterations))
    return replace(spec, clauses=(*spec.clauses, *clauses))


def separating(probe: Probe, before: Sequence[ClauseJudged], after: Sequence[ClauseJudged]) -> str | None:
    """Return how a probe separates executions with a fault (``after``) from those without; ``None`` if it does not."""
    if not before or not after or any(one.verdict == Outcome.UNKNOWN for one in (*before, *after)):
        return None
    if not probe.limit:
        held = all(one.verdict == Outcome.HOLDS for one in before)
        return "" if held and all(one.verdict == Outcome.VIOLATED for one in after) else None
    values = [[probe.value(one.robustness or 0.0) for one in group] for group in (before, after)]
    sound, faulty = (max(values[0]), min(values[1])) if probe.is_upper else (min(values[0]), max(values[1]))
    low, high = (sound, faulty) if probe.is_upper else (faulty, sound)
    if high < CLEAR * low:
        return None
    shown = [margin(value, probe.unit).lstrip("+") for value in (sound, faulty)]
    return f"{shown[0]} without the fault, {shown[1]} with it"


def probed_templates(plan: Plan) -> tuple[dict[str, str], dict[str, ProbedTemplate]]:
    """Return the template (IRI) of each variant of a plan, and the templates by IRI."""
    of_variant: dict[str, str] = {}
    templates: dict[str, ProbedTemplate] = {}
    for file in plan.files:
        model = file.acceptance
        for variant in (variant for story in model.stories for variant in story.variants):
            iri = variant.template.iri
            of_variant.setdefault(variant.iri, iri)
            if iri not in templates:
                words = tuple(_words(variant.template, model.curie))
                templates[iri] = ProbedTemplate(_local(model.curie(iri)), file.place(iri), words)
    return of_variant, templates


def _times(spec: ScenarioSpec, call: BehaviourCall) -> dict[str, TimeConstraint]:
    """Return the time constraints of probes whose events the scenario has."""
    events = {one: event for event, emits in spec.events.items() for one in each_emitter(emits)}
    first, last = call.behaviour.events[0], call.behaviour.events[-1]
    start = call.start or events.get(emitter(call.part, first) if call.part else first)
    end = call.end or events.get(emitter(call.part, last) if call.part else last)
    begin, over = events.get("scenario-start"), events.get("scenario-end")
    found: dict[str, TimeConstraint] = {}
    if start and end:
        found |= {AFTER: After(end), DURING: During(start, end), SOME_TIME: During(start, end, some_time=True)}
    if begin and over:
        found[WHOLE] = During(begin, over)
    return found


def _words(template: Template, curie: Callable[[str], str]) -> Iterator[tuple[str, str]]:
    """Yield each placeholder of a clause with its name in the template. The first behaviour names the arguments."""
    yield "begin", _local(curie(template.start))
    yield "over", _local(curie(template.end))
    behaviours = (one for one in every_clause(template.clauses) if isinstance(one, BehaviourClause))
    first = next(behaviours, None)
    if first is not None:
        yield "start", _local(curie(first.start))
        yield "end", _local(curie(first.end))
        for slot, filler in first.arguments.items():
            yield slot, _local(variable_word(curie(filler)))


def _local(name: str) -> str:
    return name.rpartition(":")[2].rpartition("/")[2]
