"""``robbdd format``: rewrite models in canonical layout, or list the models that are not in it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from robbdd_tools.base.files import Unreadable, read_text
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, OK
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.features.layout import lay_out
from robbdd_tools.syntax.study_content import STUDY
from robbdd_tools.workbench.named_files import NotAModel, named_files


def format_models(paths: Sequence[Path], check: bool) -> int:
    """Format files and the models and studies in folders.

    With ``check``, no file is written. The files that would change are listed, and the exit code is 1 if there are any.
    """
    try:
        files = named_files(paths, (STUDY,))
    except NotAModel as error:
        return fail(str(error))
    changed: list[Path] = []
    for path in files:
        text = read_text(path)
        if isinstance(text, Unreadable):
            print_note(f"{path}:1:1: error: {text.reason} [{text.code}]")
            return FAILED
        laid_out = lay_out(text)
        if laid_out == text:
            continue
        changed.append(path)
        print_line(f"{path}: {'would change' if check else 'changed'}")
        if not check:
            try:
                replace_file(path, laid_out)
            except OSError as error:
                return fail(f"{path}: {error.strerror or error}")
    print_line(f"{len(changed)} of {len(files)} files {'would change' if check else 'changed'}")
    return FINDINGS if check and changed else OK
