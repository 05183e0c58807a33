"""The built wheel and sdist work without a checkout."""

from __future__ import annotations

import subprocess
import sys
import tarfile
import venv
from pathlib import Path
from zipfile import ZipFile

import pytest

from kit import MODEL, ROOT, SCENE

pytestmark = pytest.mark.packaging


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, "-m", "build", "--outdir", folder, ROOT], check=True, capture_output=True)
    return folder


def test_an_installed_wheel_finds_its_grammars_metamodels_and_robots(built: Path, tmp_path: Path) -> None:
    """The wheel is installed into a fresh environment that only shares this one's libraries."""
    environment = tmp_path / "fresh"
    venv.create(environment, with_pip=True)
    scripts = environment / ("Scripts" if sys.platform == "win32" else "bin")
    python = scripts / "python"
    (wheel,) = built.glob("*.whl")
    # As the extension requests the bundled wheel.
    wanted = f"robbdd-tools[video] @ {wheel.as_uri()}"
    subprocess.run([python, "-I", "-m", "pip", "install", "--quiet", "--no-deps", "--", wanted], check=True)
    code = "import sysconfig; print(sysconfig.get_path('purelib'))"
    site = Path(subprocess.run([python, "-c", code], check=True, capture_output=True, text=True).stdout.strip())
    borrowed = "\n".join(path for path in sys.path if path.endswith("site-packages"))
    (site / "borrowed.pth").write_text(borrowed + "\n", encoding="utf-8")
    (tmp_path / "main.bdd").write_text(MODEL, encoding="utf-8")
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")

    where = [python, "-c", "import robbdd_tools; print(robbdd_tools.__file__)"]
    assert subprocess.run(where, check=True, capture_output=True, text=True).stdout.startswith(str(environment))
    checked = subprocess.run([scripts / "robbdd", "check", tmp_path], capture_output=True, encoding="utf-8")
    assert checked.returncode == 0, checked.stderr
    assert checked.stdout.endswith("2 files: 0 errors, 1 other remark\n"), "the models of the catalog"
    graph = subprocess.run(
        [scripts / "robbdd", "graph", tmp_path / "main.bdd", "--format", "json-ld"], check=True, capture_output=True
    )
    assert b"UserStory" in graph.stdout
    subprocess.run([scripts / "robbdd", "new", tmp_path / "project", "--template", "sorting"], check=True)
    assert (tmp_path / "project" / "sorting.bdd").is_file()
    page = "from robbdd_tools.lsp.convert import code_page; print(code_page('syntax'))"
    shown = subprocess.run([python, "-c", page], check=True, capture_output=True, text=True).stdout
    assert shown.startswith(environment.as_uri())
    robots = "from robbdd_tools.catalog.registry import load_catalog as c; import robbdd_tools.catalog.robots as r\n"
    robots += "from pathlib import Path\nprint([(Path(r.__path__[0]) / m.mjcf).is_file() for m in c().robots.values()])"
    found = subprocess.run([python, "-c", robots], check=True, capture_output=True, text=True).stdout
    assert "True" in found
    assert "False" not in found


def test_the_source_distribution_holds_what_a_build_needs(built: Path) -> None:
    (archive,) = built.glob("*.tar.gz")
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    assert {"grammar/bdd.tx", "pyproject.toml", "LICENSE", "examples/pickplace/pickplace.bdd"} <= names
    assert any(name.startswith("metamodels/") and name.endswith(".ttl") for name in names)
    assert not any("node_modules" in name for name in names)


def test_the_wheel_offers_its_plugin_to_pytest(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    with ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith(".dist-info/entry_points.txt")]
        offered = archive.read(name).decode()
    assert "[pytest11]\nrobbdd = robbdd_tools.pytest_plugin\n" in offered
