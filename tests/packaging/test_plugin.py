"""The example of a package with a predicate: built, installed, and used by a model that runs."""

from __future__ import annotations

import json
import subprocess
import sys
import venv
from pathlib import Path

import pytest

from kit import DOCS, EXAMPLES

pytestmark = pytest.mark.packaging
ROBBDD = "import sys; from robbdd_tools.start import robbdd; sys.exit(robbdd())"
CLAUSE = "goal-untouched: holds(<robot> does not collide <goal>, from <evt-pick-start> until <evt-place-end>)"


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the Python of an environment with the package, and with what this one has."""
    environment = tmp_path_factory.mktemp("plugin")
    venv.create(environment)
    found = environment / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    where = [found, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    site = Path(subprocess.run(where, check=True, capture_output=True, text=True).stdout.strip())
    borrowed = [path for path in sys.path if path.endswith("site-packages")]
    (site / "borrowed.pth").write_text("".join(f"import site; site.addsitedir({path!r})\n" for path in borrowed))
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", site, EXAMPLES / "plugin"]
    subprocess.run(install, check=True, capture_output=True)
    return found


def test_a_model_uses_the_predicate_of_an_installed_package(python: Path, tmp_path: Path) -> None:
    text = (EXAMPLES / "pickplace" / "pickplace.bdd").read_text(encoding="utf-8")
    assert CLAUSE in text
    for limit, verdict, code in (("60 deg/s", "holds", 0), ("5 deg/s", "violated", 1)):
        calm = f"calm: holds(<thing> turns slower than {limit}, from <evt-pick-start> until <evt-place-end>)"
        (tmp_path / "calm.bdd").write_text(text.replace(CLAUSE, calm), encoding="utf-8")
        scene = (EXAMPLES / "pickplace" / "bench.scene").read_text(encoding="utf-8")
        (tmp_path / "bench.scene").write_text(scene, encoding="utf-8")
        chosen = ["--where", "thing=cube0 and goal=right_ws", "--json", str(tmp_path / "results.json")]
        done = subprocess.run(
            [python, "-c", ROBBDD, "run", tmp_path / "calm.bdd", *chosen], capture_output=True, encoding="utf-8"
        )
        assert done.returncode == code, done.stdout + done.stderr
        (scenario,) = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["scenarios"]
        (clause,) = [one for one in scenario["clauses"] if "turns slower" in one["sentence"]]
        assert (clause["verdict"], clause["unit"]) == (verdict, "deg/s")


def test_the_page_shows_the_code_of_the_example() -> None:
    page = (DOCS / "own-words.md").read_text(encoding="utf-8")
    code = (EXAMPLES / "plugin" / "robbdd_turning" / "turns_slower_than.py").read_text(encoding="utf-8")
    shown = page.partition("```python\n")[2].partition("```")[0]
    for part in shown.strip().split("\n\n\n"):
        assert part in code
    toml = page.partition("```toml\n")[2].partition("```")[0]
    assert toml in (EXAMPLES / "plugin" / "pyproject.toml").read_text(encoding="utf-8")
