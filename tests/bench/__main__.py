"""``python -m tests.bench [SECTION…]``: measures and writes the figures into ``docs/performance.md``."""

from __future__ import annotations

import platform
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
PAGE = ROOT / "docs" / "performance.md"


def main(wanted: Sequence[str]) -> None:
    """Measure everything, or some sections of the page, and replace their tables; the words around them stay."""
    sys.path.insert(0, str(ROOT / "tests"))
    from tests.bench import editor, gherkin, language, limits, rejudging, running, shapes

    sections: dict[str, Callable[[], Iterable[tuple[str, str]]]] = {
        "Language": language.rows,
        "Editors": lambda: (*editor.rows(), *rejudging.rows()),
        "Shapes and queries": shapes.rows,
        "Limits": limits.rows,
        "Gherkin": gherkin.rows,
        "Runs": running.rows,
    }
    unknown = set(wanted) - set(sections)
    if unknown:
        sys.exit(f"no section '{unknown.pop()}': there are {', '.join(sections)}")
    page = PAGE.read_text(encoding="utf-8")
    machine = ("measured with", f"Python {platform.python_version()} on {platform.machine()}, {_processor()}")
    for title in wanted or sections:
        table = "".join(f"| {name} | {figure} |\n" for name, figure in [*sections[title](), machine])
        page, found = re.subn(
            rf"(?s)(?<=\n## {title}\n\n)(.*?\n)??\| what \| figure \|.*?(?=\n\n|\Z)\n?",
            lambda match, table=table: f"{match[1] or ''}| what | figure |\n|---|---|\n{table}",
            page,
        )
        assert found == 1, f"{PAGE} has no table of '{title}'"
    PAGE.write_text(page, encoding="utf-8")
    sys.stdout.write(page)


def _processor() -> str:
    """Return number and type of the processors, if the system reports them."""
    import os

    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{os.cpu_count()} × {names[0] if names else platform.processor() or 'unknown processor'}"


if __name__ == "__main__":
    main(sys.argv[1:])
