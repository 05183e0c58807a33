"""``robbdd steps``: write a skeleton of step functions for another robot or simulator."""

from __future__ import annotations

from pathlib import Path

from robbdd_tools.base.printable import printable_python
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.models import valid_model
from robbdd_tools.commands.output import fail, print_document, print_line


def write_steps(path: Path, target: Path | None, *, undefined: bool = False) -> int:
    """Print the skeleton or, if there is a file ``target``, add the missing steps to it. Return the exit code.

    If ``undefined`` is true, the skeleton leaves out the sentences that the catalog defines.
    """
    from robbdd_tools.gherkin.skeleton import add_steps, free_patterns, patterns, skeleton

    file = valid_model(path)
    if file is None:
        return FAILED
    model = file.acceptance
    wanted = free_patterns(model) if undefined else patterns(model)
    try:
        if target is None:
            print_document(printable_python(skeleton(wanted, None, path.name)[0]))
            return OK
        new = add_steps(wanted, target, path.name)
    except SyntaxError as error:
        return fail(f"{target}:{error.lineno or 1}: {error.msg}: fix the file first")
    except UnicodeDecodeError:
        return fail(f"{target} is not UTF-8 text")
    except OSError as error:
        return fail(f"{target}: {error.strerror or error}")
    print_line(f"{target}: {new} new step{'' if new == 1 else 's'}, {len(wanted) - new} already defined")
    return OK
