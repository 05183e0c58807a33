"""``robbdd gherkin``: write a folder of features that plain behave can run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.chosen_scenarios import selection
from robbdd_tools.commands.models import valid_model
from robbdd_tools.commands.output import fail, print_line

if TYPE_CHECKING:
    from robbdd_tools.gherkin.feature_files import FeaturePlan
    from robbdd_tools.gherkin.select import Wanted

EVERY = 200
"""Scenarios between two updates of the progress bar."""
LARGEST_CHECKED = 4 * 1024 * 1024
"""Largest feature, in bytes, that is parsed again as a check. Parsing takes memory, writing does not."""


@dataclass(frozen=True, slots=True)
class GherkinOptions:
    """The options of ``robbdd gherkin``.

    - ``path``: the model.
    - ``more``: further graph files that belong to the model.
    - ``folder``: the folder to write.
    - ``template``: the name of a built-in template, or the path of a user's template.
    - ``wanted``: the selection of scenarios. Runs of the features use its ``seed``, too.
    - ``expanded``: whether the definitions of named predicates replace their phrases.
    """

    path: Path
    more: Sequence[Path]
    folder: Path
    template: str
    wanted: Wanted
    expanded: bool = False


def write_gherkin(options: GherkinOptions) -> int:
    """Write the features of a model and the files that behave needs, and print their paths. Return the exit code."""
    from robbdd_tools.gherkin.feature_files import clause_origins, whole_plan
    from robbdd_tools.gherkin.render import TemplateProblem
    from robbdd_tools.gherkin.user_template import sheet
    from robbdd_tools.graph.rdf.serialize import serialize

    file = valid_model(options.path, options.more)
    if file is None:
        return FAILED
    built, model = file.graph, file.acceptance
    if not model.stories:
        return fail(f"{options.path} has no user story with a scenario, so there is no feature to write")
    try:
        template = sheet(options.template)
    except TemplateProblem as error:
        return fail(str(error))
    selected = selection(model, [variant for story in model.stories for variant in story.variants], options.wanted)
    if selected is None:
        return FAILED
    plan = whole_plan(model, clause_origins(built, file.snapshot, model))
    plan = replace(plan, scenarios=selected.scenarios, sheet=template, expanded=options.expanded)
    try:
        _write(plan, selected.total, options, serialize(built.graph, "json-ld"))
    except TemplateProblem as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"cannot write to {options.folder}: {error.strerror or error}")
    return OK


def _write(plan: FeaturePlan, total: int | None, options: GherkinOptions, json_ld: str) -> None:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from robbdd_tools.commands.terminal import terminal
    from robbdd_tools.run.prepare import copy_steps, lay_out, write_surroundings

    write_surroundings(options.folder, options.path.stem, json_ld)
    copy_steps(str(options.path), options.folder)
    console = terminal(stderr=True)
    columns = (TextColumn("writing"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("writing", total=total)
        executions = plan.model.executions
        specs = lay_out(plan, options.path.name, options.wanted.seed, options.folder, executions)
        features: dict[str, None] = {}
        for written, spec in enumerate(specs, start=1):
            features[spec.feature] = None
            if written % EVERY == 0:
                progress.update(task, completed=written)
    for feature in features:
        _check_gherkin(options.folder / feature, template=options.template)
        print_line(str(options.folder / feature))


def _check_gherkin(feature: Path, *, template: str) -> None:
    """Raise ``TemplateProblem`` if a user's template produced invalid Gherkin. Large features are not checked."""
    from robbdd_tools.gherkin.render import OURS, TemplateProblem

    if template in OURS or feature.stat().st_size > LARGEST_CHECKED:
        return
    try:
        import_module("behave.parser").parse_file(str(feature))
    except Exception as error:  # behave raises exception types of its own, which it does not document
        said = " ".join(str(error).split())
        raise TemplateProblem(template, 0, f"its output is not Gherkin: {said}") from None
