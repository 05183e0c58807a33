"""Load a model's graph with run results, for the commands that query or print it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import Unreadable, read_text
from robbdd_tools.commands.output import print_note
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.run.store import LATEST, NoSuchRun, store_beside

if TYPE_CHECKING:
    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.workbench.model import ModelFile


def graph_with_results(model: ModelFile, path: Path, results: str | None) -> BuiltGraph | None:
    """Return the graph of a model with the results of a run.

    ``results`` is a results file or a run of the project's store; if it is missing, no results are added. If the
    results cannot be used, the problem is printed and ``None`` is returned.
    """
    from robbdd_tools.graph.write.run_results import BadResults, add_results, read_results

    built = model.graph
    if results is None:
        return built
    file = Path(results)
    try:
        if results == LATEST or not file.exists():
            run = store_beside(path).find(results)
            file, text = run.folder, json.dumps(run.results())
            print_unfinished(run, run.status())
        else:
            text = read_text(file)
        if isinstance(text, Unreadable):
            raise NoSuchRun(text.reason)
        add_results(built.graph, read_results(text))
    except NoSuchRun as error:
        print_note(f"robbdd: {error}")
        return None
    except BadResults as error:
        print_note(f"robbdd: {file} contains no results of a run: {error}")
        return None
    return built
