"""``robbdd check``: print all findings about models and their imports."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from robbdd_tools.base.printable import printable_json
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.commands import FAILED, FINDINGS, OK
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_document, print_line
from robbdd_tools.syntax.study_content import STUDY
from robbdd_tools.workbench.log_findings import all_log_findings
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.named_files import NotAModel, named_files


def check(paths: Sequence[Path], as_json: bool) -> int:
    """Print all findings about files, and about the models and studies in folders; return the exit code."""
    try:
        named = named_files(paths, (STUDY,))
        studies = [path for path in named if path.suffix[1:] == STUDY]
        others = [path for path in named if path.suffix[1:] != STUDY]
        found = [finding for path in studies for finding in load_study(path).findings]
        model = load_all(others) if others else None
    except NotAModel as error:
        return fail(str(error))
    if model is not None:
        found += [*model.diagnostics, *model.scene_findings, *all_log_findings(model)]
    # The errors of a model are also found where a study imports it.
    found = list(dict.fromkeys(found))
    files = () if model is None else model.files
    errors = sum(finding.is_error for finding in found)
    if as_json:
        for finding in found:
            print_document(printable_json(finding.as_json()) + "\n")
    else:
        print_findings(found, print_line)
        print_line(_summary(len(files) + len(studies), errors, len(found) - errors))
    if any(file.is_unreadable for file in files):
        return FAILED
    return FINDINGS if errors else OK


def _summary(files: int, errors: int, others: int) -> str:
    return f"{_counted(files, 'file')}: {_counted(errors, 'error')}, {_counted(others, 'other remark')}"


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
