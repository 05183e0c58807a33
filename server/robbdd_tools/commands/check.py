"""``robbdd check``: print all findings about models and their imports."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from robbdd_tools.base.printable import printable_json
from robbdd_tools.campaign.study_file import SUFFIX, load_study
from robbdd_tools.commands import FAILED, FINDINGS, OK
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_document, print_line
from robbdd_tools.workbench.model import NotAModel, load_all


def check(paths: Sequence[Path], as_json: bool) -> int:
    """Print all findings about files and studies, and about the models in folders; return the exit code."""
    studies = [path for path in paths if path.suffix == SUFFIX]
    others = [path for path in paths if path.suffix != SUFFIX]
    try:
        found = [finding for path in studies for finding in load_study(path).findings]
        model = load_all(others) if others else None
    except NotAModel as error:
        return fail(str(error))
    if model is not None:
        found += [*model.diagnostics, *model.scene_findings]
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
