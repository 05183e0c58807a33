"""Terminal display of a run: progress bar, verdicts as they arrive, summary."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from rich.padding import Padding
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Column, Table
from rich.text import Text

from robbdd_tools.base.printable import printable
from robbdd_tools.commands.failure_summary import failure_summary
from robbdd_tools.commands.rate_lines import rate_lines
from robbdd_tools.commands.terminal import plain, terminal
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    DebuggerAwaited,
    LogLine,
    Output,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.protocol.run_folder import DEBUG_HOST
from robbdd_tools.protocol.specs import plain_name
from robbdd_tools.run.readable import readable
from robbdd_tools.run.report import (
    SIGNS,
    contact_words,
    deciding_words,
    margin,
    plain_sentence,
    values_words,
    verdict_words,
)

if TYPE_CHECKING:
    from types import TracebackType

    from rich.progress import Task

    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.run.results import RunResults, ScenarioResult

BESIDE = len("  ✔   +1000.0 mm  at 10.00 s")
"""Columns of a clause's sign, margin and instant."""
NARROWEST = 10
"""Minimum columns of a sentence, however narrow the terminal."""
MAX_PRINTED = 100
"""Maximum lines shown of users' code output in one scenario."""
MAX_CONTACTS = 5
"""Maximum contacts shown for one scenario."""
INDENT = (0, 0, 0, 6)
"""Padding of a reason, which is indented below its clauses."""
_BADNESS = (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS)
STYLES = {Outcome.HOLDS: "green", Outcome.VIOLATED: "bold red", Outcome.UNKNOWN: "yellow"}


class Display:
    """Prints the messages of a run.

    If the cursor of the terminal can be moved, a progress bar is shown and lines are wrapped between words. Any other
    output gets plain lines without wrapping, so that other programs can read them. ``made`` stands between the time of
    the executions and the time that the work took (``12.0 s simulated in 3.0 s``). If ``brief`` is true, only failures
    and pass rates are printed. If ``live`` is true, each verdict is also printed as soon as it is known.
    """

    def __init__(
        self,
        results: RunResults,
        total: int | None = None,
        made: str = "simulated in",
        *,
        brief: bool = False,
        live: bool = False,
    ) -> None:
        self._results = results
        self._live = live
        self._brief = brief
        self._made = made
        self._total = len(results.scenarios) if total is None else total
        self._console = terminal()
        self._drawn = self._console.is_terminal and not self._console.is_dumb_terminal
        self._console.soft_wrap = not self._drawn
        self._progress = Progress(
            _Counts(),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=self._console,
            transient=True,
            disable=not self._drawn,
        )
        # A resumed run already has finished scenarios.
        finished = [scenario for scenario in results.scenarios if scenario.finished is not None]
        self._ended = Counter(scenario.verdict for scenario in finished)
        self._shown = Counter(self._ended)
        self._worst: dict[int, Outcome] = {}
        self._faults: dict[str, int] = {}
        self._printed: dict[int, list[str]] = {}
        self._task = self._progress.add_task("", total=self._total, completed=len(finished), counts=Text("starting"))

    def __enter__(self) -> Display:
        self._progress.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        self._progress.stop()

    def watch(self, message: RunMessage) -> None:
        """Count a message on arrival, which may be before it is shown."""
        match message:
            case ScenarioStarted():
                self._worst.pop(message.index, None)
            case ClauseJudged():
                worst = self._worst.get(message.index, Outcome.HOLDS)
                self._worst[message.index] = min(worst, Outcome(message.verdict), key=_BADNESS.index)
            case ScenarioFinished():
                # Without any clause there is no evidence.
                self._ended[self._worst.get(message.index, Outcome.UNKNOWN)] += 1
                self._progress.update(self._task, counts=self._counts(), advance=1)
            case _:
                pass

    def show(self, message: RunMessage) -> None:
        """Show a message. Its effect must already be in the results."""
        match message:
            case RunStarted():
                self._progress.update(self._task, counts=self._counts())
            case ScenarioFinished():
                self._scenario(message.index)
                self._tenth()
            case ClauseJudged() if self._live:
                self._verdict(message)
            case UserCodeFailed(_, fault):
                self._fault(fault)
            case Output(None, text):
                self._output(text.split("\n"))
            case Output(int(index), text):
                self._printed.setdefault(index, []).extend(text.split("\n"))
            case DebuggerAwaited(port):
                self._console.print(plain(f"waiting for a debugger at {DEBUG_HOST}:{port} (Debug Adapter Protocol)"))
            case LogLine(level, text) if level != "info":
                self._console.print(plain(f"{level}: {text}", STYLES[Outcome.UNKNOWN]))
            case _:
                pass

    def _verdict(self, message: ClauseJudged) -> None:
        """Print a verdict while others are still open."""
        clauses = {clause.line: clause for clause in self._results.scenarios[message.index].spec.clauses}
        sentence = plain_sentence(clauses[message.line].sentence)
        self._console.print(plain(f"{verdict_words(message)}: {sentence}", STYLES[Outcome(message.verdict)]))

    def _fault(self, fault: Fault) -> None:
        """Print an error in users' code with its traceback.

        An error that affects several scenarios is printed only once.
        """
        if fault.id in self._faults:
            return
        self._faults[fault.id] = number = len(self._faults) + 1
        self._console.print(plain(f"error {number}: {fault.code} failed", STYLES[Outcome.VIOLATED]))
        for line in fault.traceback():
            self._console.print(plain(line))

    def _output(self, lines: Sequence[str]) -> None:
        """Print the output of users' code so that it can be distinguished from the output of RobBDD."""
        for line in lines[:MAX_PRINTED]:
            self._console.print(plain(f"  │ {line}"))
        if len(lines) > MAX_PRINTED:
            more = _counted(len(lines) - MAX_PRINTED, "more line")
            self._console.print(Text(f"  │ … {more} in the log of the run"))

    def broken(self, reason: str) -> None:
        """Print why the run is incomplete."""
        self._progress.stop()
        self._console.print(plain(f"the run is incomplete: {reason}", STYLES[Outcome.VIOLATED]))

    def summary(self, results: RunResults) -> None:
        """Print the final number of scenarios with each verdict."""
        self._progress.stop()
        self._results = results
        for words in self._results.choices():
            self._console.print(plain(words, STYLES[Outcome.UNKNOWN]))
        for clause, policy in self._results.policies().items():
            self._console.print(Text(f"{plain_name(clause)} is judged by the policy {policy}, not by its predicate"))
        for name, reason in self._vacuous():
            self._console.print(plain(f"{name} proves little: {reason}", STYLES[Outcome.UNKNOWN]))
        finished = [scenario for scenario in self._results.scenarios if scenario.finished is not None]
        shown = self._results.scenarios if self._total == len(self._results.scenarios) else finished
        for outcome, words in failure_summary(shown, self._faults) if len(shown) > 1 else ():
            self._console.print(plain(words, STYLES[outcome]))
        for words in rate_lines(finished, self._total) if self._brief else ():
            self._console.print(Text(words))
        outcomes = [scenario.verdict for scenario in shown]
        counts = [f"{outcomes.count(outcome)} {_word(outcome)}" for outcome in Outcome]
        executions = _executions(finished)
        shared = "" if len(executions) == len(finished) else f"; judged from {_counted(len(executions), 'execution')}"
        simulated = sum(scenario.finished.simulated for scenario in executions if scenario.finished)
        wall = sum(scenario.finished.wall for scenario in finished if scenario.finished)
        resampled = sum(scenario.finished.resampled for scenario in executions if scenario.finished)
        again = f"; {_counted(resampled, 'initial place')} drawn again" if resampled else ""
        self._console.print(
            f"{_counted(self._total, 'scenario')}: {', '.join(counts)}"
            f"  ({self._seeds(shown)}; {simulated:.1f} s {self._made} {wall:.1f} s{shared}{again})"
        )

    def _seeds(self, shown: Iterable[ScenarioResult]) -> str:
        """Return the seeds from which those of the executions were computed: executions of a model may state theirs."""
        stated = (scenario.spec.execution for scenario in shown)
        own = (None if execution is None else execution.seed for execution in stated)
        seeds = dict.fromkeys(self._results.manifest.seed if seed is None else seed for seed in own)
        return f"seed{'s' * (len(seeds) > 1)} {', '.join(map(str, seeds)) or self._results.manifest.seed}"

    def _counts(self) -> Text:
        """Return the counts as the editor does: a violated scenario has failed, an unknown one has errored."""
        failed, errored = self._ended[Outcome.VIOLATED], self._ended[Outcome.UNKNOWN]
        return Text.assemble(
            (f"{self._ended[Outcome.HOLDS]} hold", STYLES[Outcome.HOLDS]),
            ", ",
            (f"{failed} failed", STYLES[Outcome.VIOLATED] if failed else ""),
            *([", ", (f"{errored} errored", STYLES[Outcome.UNKNOWN])] if errored else []),
        )

    def _tenth(self) -> None:
        """Print a line after each tenth of a brief run if no bar shows its progress."""
        done = self._shown.total()
        if self._brief and not self._drawn and done * 10 // self._total > (done - 1) * 10 // self._total:
            self._console.print(Text(f"{done} of {self._total} scenarios: {self._shown[Outcome.HOLDS]} hold"))

    def _vacuous(self) -> Iterator[tuple[str, str]]:
        """Yield the title of each clause whose verdict proves little, and the reason, in the order of the model."""
        reasons = self._results.vacuous()
        return ((name, reasons[iri]) for iri, name in self._results.titles().items() if iri in reasons)

    def _scenario(self, index: int) -> None:
        scenario = self._results.scenarios[index]
        spec = scenario.spec
        outcome = scenario.verdict
        self._shown[outcome] += 1
        if self._brief and outcome is Outcome.HOLDS:
            self._printed.pop(index, None)
            return
        self._console.print(plain(f"{spec.name}  {values_words(spec)}", STYLES[outcome]))
        self._output(self._printed.pop(index, []))
        rows = [
            (
                readable(known, spec),
                printable(plain_sentence(clause.sentence)),
                printable(deciding_words(clause, known)),
            )
            for clause in spec.clauses
            if (known := scenario.judged.get(clause.line)) is not None
            and not (self._brief and known.verdict == Outcome.HOLDS)
        ]
        width = max((len(sentence) for _, sentence, _ in rows), default=0)
        for number, (judged, sentence, decided) in enumerate(rows):
            if self._drawn:
                fitting = max(self._console.width - BESIDE, NARROWEST)
                self._console.print(_clause_cells(judged, sentence, min(width, fitting)))
            else:
                self._console.print(_clause_line(judged, sentence, width))
            if decided:
                self._console.print(Padding(Text(decided), INDENT) if self._drawn else Text(f"      {decided}"))
            below = rows[number + 1][0].reason if number + 1 < len(rows) else ""
            if judged.reason not in ("", below):
                number = self._faults.get(judged.fault)
                words = judged.reason if number is None else f"no evidence, because of error {number}"
                reason = plain(words, STYLES[Outcome(judged.verdict)])
                self._console.print(Padding(reason, INDENT) if self._drawn else Text("      ").append(reason))
        contacts = () if scenario.finished is None else scenario.finished.contacts
        for contact in contacts[:MAX_CONTACTS]:
            self._console.print(plain(f"  contact: {contact_words(contact)}", STYLES[Outcome.UNKNOWN]))
        if len(contacts) > MAX_CONTACTS:
            more = _counted(len(contacts) - MAX_CONTACTS, "more contact")
            self._console.print(plain(f"  … {more} in the results of the run", STYLES[Outcome.UNKNOWN]))


class _Counts(ProgressColumn):
    """The field ``counts`` of a task, which is styled text."""

    def render(self, task: Task) -> Text:
        """Return the current text of the field."""
        return task.fields["counts"]


def _executions(finished: Iterable[ScenarioResult]) -> list[ScenarioResult]:
    """Return one scenario for each execution.

    For a shared execution, this is the scenario with the longest simulated time.
    """
    furthest: dict[int | str, ScenarioResult] = {}
    for number, scenario in enumerate(finished):
        key = number if scenario.spec.tree is None else scenario.spec.tree.name
        known = furthest.setdefault(key, scenario)
        if known.finished and scenario.finished and scenario.finished.simulated > known.finished.simulated:
            furthest[key] = scenario
    return list(furthest.values())


def _clause_line(judged: ClauseJudged, sentence: str, width: int) -> Text:
    sign, shown = _verdict(judged)
    return Text.assemble("  ", sign, " ", sentence.ljust(width) if shown else sentence, shown)


def _clause_cells(judged: ClauseJudged, sentence: str, width: int) -> Table:
    """Lay out a clause in a table. A long sentence wraps in its column; the margin and the instant do not wrap."""
    cells = Table.grid(Column(width=4), Column(width=width), Column(no_wrap=True))
    sign, shown = _verdict(judged)
    cells.add_row(Text("  ").append(sign), Text(sentence), shown)
    return cells


def _verdict(judged: ClauseJudged) -> tuple[Text, Text]:
    """Return the sign of a judged clause, and its margin and its instant if it has them."""
    outcome = Outcome(judged.verdict)
    style = STYLES[outcome]
    shown = printable(margin(judged.robustness, judged.unit))
    instant = f"  at {judged.at:.2f} s" if outcome is Outcome.VIOLATED and judged.at is not None else ""
    return Text(SIGNS[outcome], style), Text(f"  {shown:>9}{instant}" if shown or instant else "", style)


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _word(outcome: Outcome) -> str:
    return {Outcome.HOLDS: "hold", Outcome.VIOLATED: "violated", Outcome.UNKNOWN: "unknown"}[outcome]
