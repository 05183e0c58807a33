"""How long Gherkin takes per scenario, whether that stays so, and whether memory does."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from kit import EVENTS, SCENE, TEMPLATE

UPSTREAM = {100: (46, 13), 1000: (355, 282), 10_000: (3491, 11067)}
"""Scenarios → milliseconds of the upstream prototype to expand and to render them, on 2 cores at 2.5 GHz."""
MANY = 100_000
"""Numbers of scenarios that show whether time and memory stay constant."""
_SCRIPT = """
import json, resource, shutil, sys, time
from pathlib import Path
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.gherkin.feature_files import whole_plan
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.names.project import Project
from robbdd_tools.run.prepare import lay_out
folder = Path(sys.argv[1])
uri = path_to_uri(folder / "main.bdd")
project = Project()
project.load(uri)
model = read_model(build_graph(project.snapshot(), uri).graph)
plan = whole_plan(model)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
start = time.process_time()
count = sum(1 for _ in lay_out(plan, "main.bdd", 1, folder / "out"))
seconds = time.process_time() - start
grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
size = sum(path.stat().st_size for path in (folder / "out").rglob("*") if path.is_file())
print(json.dumps([count, seconds, grown / 1024, size]))
"""


def model(scenarios: int) -> str:
    """Return a model whose variation is a product of that many scenarios (a power of ten)."""
    digits = len(str(scenarios)) - 1
    variables = [f"n{index}" for index in range(digits)]
    template = TEMPLATE.replace("var goal", "var goal\n" + "".join(f"    var {name}\n" for name in variables))
    clauses = "".join(
        f"        and c{name}: holds(<goal> has config {name} = <{name}>, before <pick-start>)\n" for name in variables
    )
    template = template.replace(
        "on-bench: holds(<part> is located at <goal>, before <pick-start>)\n",
        f"( on-bench: holds(<part> is located at <goal>, before <pick-start>)\n{clauses})\n",
    )
    values = "".join(f"                var <fetch.{name}>: {{ 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }}\n" for name in variables)
    return f"""{EVENTS}{template}User Story (ns=t) counting {{
    As A "operator" I Want "many scenarios" So That "speed shows"
    Scenarios:
        Scenario every {{
            template: <fetch>
            scene: <bench_scene>
            variation:
                var <fetch.part>: {{ <parts.bolt> }}
                var <fetch.robot>: {{ <arms.panda> }}
                var <fetch.goal>: {{ <places.tray_ws> }}
{values}        }}
}}
"""


def rows() -> Iterator[tuple[str, str]]:
    """Yield a name and a figure for each measurement."""
    for scenarios, (expand, render) in UPSTREAM.items():
        seconds, _, _ = _measured(scenarios)
        theirs = expand + render
        yield (
            f"features, line maps and manifest of {scenarios} scenarios",
            f"{1000 * seconds:.0f} ms of processor time (the upstream prototype: {theirs} ms for the features alone)",
        )
    seconds, grown, size = _measured(MANY)
    each = 1e6 * seconds / MANY
    yield (
        f"the same of {MANY} scenarios",
        f"{seconds:.0f} s, {each:.0f} µs each; memory grows by {grown:.0f} MiB for {size / 2**30:.1f} GiB of files",
    )


def _measured(scenarios: int) -> tuple[float, float, int]:
    """Return processor time (s), growth of the peak memory (MiB) and bytes written, measured in a new process."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "lab.scene").write_text(SCENE, encoding="utf-8")
        (folder / "main.bdd").write_text(model(scenarios), encoding="utf-8")
        done = subprocess.run([sys.executable, "-c", _SCRIPT, name], capture_output=True, check=True)
        count, seconds, grown, size = json.loads(done.stdout)
    assert count == scenarios
    return seconds, grown, size
