"""``python -m tests.bench``: measures and rewrites ``docs/performance.md``."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
PAGE = ROOT / "docs" / "performance.md"
HEAD = """# Performance

Written by `make bench`; compare figures within one run only, machines differ and are noisy. Those of
the language are processor time of one thread.
"""


def main() -> None:
    """Measure everything and write the page."""
    sys.path.insert(0, str(ROOT / "tests"))
    from tests.bench import gherkin, language, running, shapes

    page = [HEAD, f"Measured with Python {platform.python_version()} on {platform.machine()}, {_processor()}.\n"]
    page += _section("Language", language.rows())
    page += _section("Shapes and queries", shapes.rows())
    page += _section("Gherkin", gherkin.rows())
    page += _section("Runs", running.rows())
    PAGE.write_text("\n".join(page), encoding="utf-8")
    sys.stdout.write(PAGE.read_text(encoding="utf-8"))


def _section(title: str, rows: Iterable[tuple[str, str]]) -> list[str]:
    table = [f"| {name} | {figure} |" for name, figure in rows]
    return [f"## {title}\n", "| what | figure |", "|---|---|", *table, ""]


def _processor() -> str:
    """Return number and kind of the processors, where the system tells."""
    import os

    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{os.cpu_count()} × {names[0] if names else platform.processor() or 'unknown processor'}"


if __name__ == "__main__":
    main()
