"""The coverage of requirements by scenarios, with the verdicts of the latest runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.features.markdown import code, literal
from robbdd_tools.features.pass_rates import Missing, counted, missing_executions, outcome_of_all
from robbdd_tools.features.rejudged_results import BADNESS, SIGNS
from robbdd_tools.features.run_verdicts import digest, variant_digest
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.names.elements import site_of
from robbdd_tools.names.requirement_links import Verifier, key_of, requirements_of, verifiers
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import Findings, JudgedScenario
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

MAX_LISTED = 10
MAX_RELATED = 5


@dataclass(frozen=True, slots=True)
class Evidence:
    """The result of the latest executions of a scenario variant for a requirement that the variant verifies.

    - ``held``: the number of executions in which all its clauses held.
    - ``run``: the number of all executions.
    - ``worst``: the worst outcome; ``""`` if the variant was never run.
    - ``vacuous``: true if none of its clauses could have failed.
    - ``stale``: true if the text of the variant, its template or a clause has changed since then.
    - ``missing``: the number of executions that were not made.
    """

    verifier: Verifier
    held: int
    run: int
    worst: str
    vacuous: bool
    stale: bool
    missing: Missing = 0

    @property
    def outcome(self) -> str:
        """The outcome of all executions that there should be; ``""`` if the variant was never run."""
        return outcome_of_all(self.worst, self.missing)

    @property
    def words(self) -> str:
        """The last verdict in words."""
        if not self.worst:
            return "not run"
        remarks = [" (vacuous)"] * self.vacuous + [" (stale)"] * self.stale
        counts = counted(self.held, self.run, self.missing, "held")
        return f"{SIGNS[self.outcome]} {counts}{''.join(remarks)}"


@dataclass(frozen=True, slots=True)
class Coverage:
    """A requirement with the scenarios that verify it."""

    requirement: Definition
    evidence: tuple[Evidence, ...]

    @property
    def outcome(self) -> str:
        """The worst outcome of all executions that there should be; ``""`` if no scenario was run."""
        worst = min((one.outcome for one in self.evidence if one.worst), key=BADNESS.index, default="")
        return "unknown" if worst == "holds" and not all(one.worst for one in self.evidence) else worst

    @property
    def is_vacuous(self) -> bool:
        """Whether there are executions, and none of their clauses could have failed."""
        known = [one for one in self.evidence if one.worst]
        return bool(known) and all(one.vacuous for one in known)

    @property
    def label(self) -> str:
        """The coverage as one line of text."""
        count = len(self.evidence)
        scenarios = f"verified by {count} scenario{'' if count == 1 else 's'}" if count else "no scenario verifies it"
        known = [one for one in self.evidence if one.worst]
        if not known:
            return f"{scenarios}, not run" if count else scenarios
        held, run = sum(one.held for one in known), sum(one.run for one in known)
        remarks = [" (vacuous)"] * self.is_vacuous + [" (stale)"] * any(one.stale for one in known)
        gaps = [one.missing for one in known]
        missing = None if None in gaps else sum(one or 0 for one in gaps)
        counts, unrun = counted(held, run, missing, "held"), count - len(known)
        return f"{scenarios} · {SIGNS[self.outcome]} {counts}{''.join(remarks)}" + (
            f" · {unrun} not run" if unrun else ""
        )


def coverage(snapshot: Snapshot, requirements: Sequence[Definition], findings: Findings) -> list[Coverage]:
    """Return the coverage of requirements of one file."""
    found = verifiers(snapshot, requirements)
    return [
        Coverage(one, tuple(_evidence(snapshot, verifier, findings) for verifier in found[key_of(one)]))
        for one in requirements
    ]


def coverage_of_file(snapshot: Snapshot, uri: str, findings: Findings) -> list[Coverage]:
    """Return the coverage of the requirements that a file declares, in text order."""
    file = snapshot.file(uri)
    return [] if file is None else coverage(snapshot, requirements_of(file), findings)


def _evidence(snapshot: Snapshot, verifier: Verifier, findings: Findings) -> Evidence:
    known = [one for one in findings.variants.get(verifier.variant.iri, ()) if one.finished]
    if not known:
        return Evidence(verifier, 0, 0, "", vacuous=False, stale=False)
    outcomes = [_outcome(one, verifier) for one in known]
    judged = [one.clauses[iri] for one in known for iri in verifier.clauses if iri in one.clauses]
    vacuous = bool(judged) and all(one.vacuous for one in judged)
    now = variant_digest(snapshot, verifier.variant)
    worst = min(outcomes, key=BADNESS.index)
    stale = any(one.digest != now for one in known) and (verifier.whole or _changed(snapshot, verifier, known))
    every, count = findings.variants[verifier.variant.iri], number_of_scenarios(verifier.variant)
    missing = missing_executions(every, count)
    return Evidence(verifier, outcomes.count("holds"), len(known), worst, vacuous, stale, missing)


def _changed(snapshot: Snapshot, verifier: Verifier, known: Sequence[JudgedScenario]) -> bool:
    """Return whether a clause that verifies the requirement has changed since the executions judged it."""
    files = [one.uri for one in (verifier.variant.definition, verifier.variant.template) if one is not None]
    for iri, clause in verifier.clauses.items():
        now = {digest(snapshot, uri, clause.span) for uri in files}
        if any(iri in one.clauses and one.clauses[iri].digest not in now for one in known):
            return True
    return False


def _outcome(scenario: JudgedScenario, verifier: Verifier) -> str:
    """Return an execution's outcome for a requirement: the outcome of the scenario, or the worst of the clauses."""
    if verifier.whole:
        return scenario.outcome
    outcomes = [scenario.clauses[iri].outcome if iri in scenario.clauses else "unknown" for iri in verifier.clauses]
    return min(outcomes, key=BADNESS.index, default="unknown")


def requirement_diagnostics(snapshot: Snapshot, uri: str, findings: Findings) -> Iterator[Diagnostic]:
    """Report each requirement of a file that the latest runs did not show to be satisfied."""
    for one in coverage_of_file(snapshot, uri, findings) if findings.variants else ():
        name, place = one.requirement.symbol.path, one.requirement.span
        failing = [entry for entry in one.evidence if entry.worst not in ("", "holds") and not entry.stale]
        if failing:
            worst = min((entry.worst for entry in failing), key=BADNESS.index)
            severity = Severity.ERROR if worst == "violated" else Severity.WARNING
            verb = "violated" if worst == "violated" else "left open"
            listed = ", ".join(f"{_name(entry)} {entry.words}" for entry in failing[:MAX_RELATED])
            message = f"the last run {verb} the requirement '{name}': {listed}"
            related = tuple(_related(entry) for entry in failing[:MAX_RELATED])
            yield Diagnostic(uri, place, severity, "requirement-failed", message, related)
        elif one.is_vacuous and not any(entry.stale for entry in one.evidence):
            message = (
                f"the last run proved little about the requirement '{name}': no clause that verifies it could have "
                "failed. Add a scenario in which one could"
            )
            related = tuple(_related(entry) for entry in one.evidence[:MAX_RELATED] if entry.vacuous)
            yield Diagnostic(uri, place, Severity.WARNING, "requirement-vacuous", message, related)


def requirement_words(snapshot: Snapshot, definition: Definition, findings: Findings) -> Iterator[str]:
    """Yield the text of a requirement, its source and its coverage as Markdown."""
    site = site_of(snapshot, definition)
    root = None if site is None else site.tree
    if isinstance(root, tree.Requirement) and root.name.text == definition.symbol.path:
        yield f"> {literal(root.text.value)}"
        if root.identifier is not None:
            yield f"Identifier: {literal(root.identifier.value)}"
        if root.source is not None:
            yield f"Source: {literal(root.source.value)}"
    (found,) = coverage(snapshot, [definition], findings)
    lines = [f"- {code(_name(one))}{_clauses(one)}: {one.words}" for one in found.evidence[:MAX_LISTED]]
    more = len(found.evidence) - MAX_LISTED
    lines += [f"- … and {more} more"] * (more > 0)
    yield "\n".join((f"{found.label[0].upper()}{found.label[1:]}", *[""] * bool(lines), *lines))


def _name(evidence: Evidence) -> str:
    return evidence.verifier.variant.definition.symbol.path


def _clauses(evidence: Evidence) -> str:
    if evidence.verifier.whole:
        return ""
    return f" ({', '.join(code(one.name) for one in evidence.verifier.clauses.values())})"


def _related(evidence: Evidence) -> Related:
    place = evidence.verifier.variant.definition
    return Related(place.uri, place.span, f"{_name(evidence)}: {evidence.words}")
