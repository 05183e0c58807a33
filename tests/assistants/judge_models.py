"""Judge models that were written from the requirements: ``.venv/bin/python tests/assistants/judge_models.py FOLDER``.

``FOLDER`` has a folder with models for each requirement, named by its ``id``. A model is *clean* if it has no error and
no warning, and *faithful* if its clauses also state the requirement.
"""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import robbdd_tools as robbdd

REQUIREMENTS = Path(__file__).with_name("requirements.toml")
NAME = r'"[^"]*"'
NUMBER = r"[\d.]+"


@dataclass(frozen=True)
class Requirement:
    """A requirement in prose, and patterns of the clauses that state it."""

    id: str
    prose: str
    clauses: tuple[str, ...]
    matches: int = 1
    scenarios: int = 1
    most: int | None = None


@dataclass(frozen=True)
class Judgement:
    """Whether a model has neither error nor warning, whether it states its requirement, and what is missing."""

    clean: bool
    faithful: bool
    remark: str = ""


def requirements() -> list[Requirement]:
    """Return all requirements."""
    data = tomllib.loads(REQUIREMENTS.read_text(encoding="utf-8"))["requirement"]
    return [requirement(one) for one in data]


def requirement(stated: Mapping[str, Any]) -> Requirement:
    """Return a requirement as it is stated in the file."""
    return Requirement(
        stated["id"],
        stated["prose"],
        tuple(stated["clauses"]),
        stated.get("matches", 1),
        stated.get("scenarios", 1),
        stated.get("most"),
    )


def judged(wanted: Requirement, folder: Path) -> Judgement:
    """Judge the models in a folder by a requirement."""
    if not any(folder.glob("*.bdd")):
        return Judgement(False, False, "no model")
    model = robbdd.load(folder)
    findings = [one for one in model.diagnostics if one.severity in (robbdd.Severity.ERROR, robbdd.Severity.WARNING)]
    if any(one.is_error for one in findings):
        return Judgement(False, False, str(findings[0]))
    clean, plan = not findings, model.scenarios()
    if not wanted.scenarios <= len(plan) <= (wanted.most or len(plan)):
        return Judgement(clean, False, f"{len(plan)} scenarios")
    for spec in plan.scenarios:
        sentences = [clause.sentence for clause in spec.clauses]
        for pattern in wanted.clauses:
            found = [one for one in sentences if re.search(expression(pattern), one)]
            if len(found) < wanted.matches:
                return Judgement(clean, False, f"{spec.name}: no clause reads {pattern}")
    return Judgement(clean, True, "" if clean else str(findings[0]))


def expression(pattern: str) -> str:
    """Return a pattern of the requirements as a regular expression."""
    return re.sub(r"(?<![\w\"])_(?![\w\"])", lambda _: NAME, pattern).replace("{n}", NUMBER)


def main(folder: Path) -> int:
    """Print the judgement of each requirement, and how many models are clean and faithful."""
    found = {wanted.id: judged(wanted, folder / wanted.id) for wanted in requirements()}
    for name, one in found.items():
        print(f"{name:24}{'clean' if one.clean else '–':8}{'faithful' if one.faithful else '–':10}{one.remark}")
    clean, faithful = sum(one.clean for one in found.values()), sum(one.faithful for one in found.values())
    print(f"{clean} clean, {faithful} faithful, of {len(found)}")
    return 0 if all(one.clean and one.faithful for one in found.values()) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
