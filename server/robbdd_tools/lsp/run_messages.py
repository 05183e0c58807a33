"""The notification ``robbdd/runMessage``: a message of a run, with the texts and places that a client needs.

``docs/schemas/runmessage.schema.json`` describes it.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    RunFinished,
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec
from robbdd_tools.run.report import failure_words, plain_sentence, values_words

if TYPE_CHECKING:
    from robbdd_tools.lsp.run_request import RunText
    from robbdd_tools.run.consequences import Consequence
    from robbdd_tools.run.results import RunResults

RUN_MESSAGE = "robbdd/runMessage"


def for_client(
    run: str,
    text: RunText,
    results: RunResults,
    message: RunMessage,
    *,
    cancelled: bool = False,
    because: Consequence | None = None,
) -> dict[str, Any]:
    """Return the parameters of the notification about a message of the run named ``run``.

    ``cancelled`` is true for a clause that a cancelled run left open. If a clause is unknown only because of another
    clause, ``because`` is this other clause.
    """
    fields: dict[str, Any] = {"type": type(message).__name__, **asdict(message)}
    match message:
        case ScenarioStarted(index):
            spec = results.scenarios[index].spec
            fields |= {
                "name": spec.name,
                "values": values_words(spec),
                "variant": spec.variant,
                "variation": spec.variation,
                "execution": None if spec.execution is None else spec.execution.iri,
                "repetition": spec.repetition,
                "source": text.places.declarations.get(spec.variant),
                "row": text.places.rows.get((spec.variant, spec.variation)),
            }
        case ClauseStarted(index, line) | ClauseJudged(index, line):
            clause = clause_at(results, index, line)
            if clause is not None:
                fields |= {
                    "clause": clause.iri,
                    "position": results.scenarios[index].spec.clauses.index(clause),
                    "name": clause.name,
                    "role": clause.role,
                    "sentence": plain_sentence(clause.sentence),
                    "source": text.places.declarations.get(clause.iri),
                }
            if isinstance(message, ClauseJudged):
                fields["cancelled"] = cancelled
                fields["failure"] = failure_words(message, clause)
                fields["because"] = because and cause_for_client(because, results.scenarios[index].spec)
        case UserCodeFailed(_, fault):
            fields["id"], fields["lines"] = fault.id, [f"{fault.code} failed", *fault.traceback()]
        case ScenarioFinished(index):
            fields["verdict"] = str(results.scenarios[index].verdict)
        case RunFinished():
            fields["vacuous"] = dict(results.vacuous())
        case _:
            pass
    return {"run": run, "uri": text.uri, "message": fields}


def cause_for_client(because: Consequence, spec: ScenarioSpec) -> dict[str, Any]:
    """Return the cause of a clause that is unknown because of another clause of its scenario."""
    return {"clause": spec.clauses[because.position].iri, "position": because.position, "words": because.words}


def clause_at(results: RunResults, index: int, line: int) -> ClauseSpec | None:
    """Return the clause of a scenario on a feature line."""
    return next((clause for clause in results.scenarios[index].spec.clauses if clause.line == line), None)
