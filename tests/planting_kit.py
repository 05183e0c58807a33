"""A hostile folder: it contains a module of every name that one of our interpreters may import."""

from __future__ import annotations

import re
import shutil
import sys
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from pathlib import Path

from kit import EXAMPLES

_NAME = re.compile(r"[A-Za-z0-9._-]+")
CUSTOM = ("sitecustomize", "usercustomize", "robbdd_tools", "robbdd_start", "__main__", "environment", "conftest")


def dependencies() -> set[str]:
    """Normalised names of the distributions that robbdd-tools requires, directly or not, installed or optional."""
    found: set[str] = set()
    waiting = ["robbdd-tools"]
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        found.add(name)
        try:
            required = requires(name) or []
        except PackageNotFoundError:
            continue
        waiting += [match[0].lower().replace("_", "-") for entry in required if (match := _NAME.match(entry))]
    return found


def importable_names() -> set[str]:
    """Names of all modules that an interpreter of ours might look for."""
    wanted = dependencies()
    installed = {
        module
        for module, owners in packages_distributions().items()
        if {owner.lower().replace("_", "-") for owner in owners} & wanted
    }
    guessed = {name.replace("-", "_") for name in wanted}
    names = {*sys.stdlib_module_names, *installed, *guessed, *CUSTOM}
    return {name for name in names if name.isidentifier()}


class HostileFolder:
    """A copy of the example in ``folder/models``, planted; each planted module writes its name when it runs."""

    def __init__(self, folder: Path) -> None:
        self.root = folder
        self.models = folder / "models"
        self._log = folder / "imported.log"
        shutil.copytree(EXAMPLES / "pickplace", self.models)
        for place in (folder, self.models):
            self.plant(place)

    def plant(self, place: Path) -> None:
        """Put a module of every name into a folder, and a distribution that adds a word to the catalog."""
        for name in importable_names():
            self._module(place / f"{name}.py", name)
        package = place / "robbdd_tools"
        package.mkdir()
        self._module(package / "__init__.py", "robbdd_tools")
        self._module(place / "planted_word.py", "planted_word")
        # Where Python would look if its variables named this folder.
        user_site = place / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"
        user_site.mkdir(parents=True)
        (user_site / "planted.pth").write_text(f"import sys; open({str(self._log)!r}, 'a').write('pth\\n')\n")
        metadata = place / "planted_word-1.0.dist-info"
        metadata.mkdir()
        (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: planted-word\nVersion: 1.0\n")
        groups = ("robbdd_tools.catalog", "rdf.plugins.parser", "rdf.plugins.store", "pytest11")
        (metadata / "entry_points.txt").write_text("".join(f"[{one}]\nplanted = planted_word:WORD\n" for one in groups))

    def imported(self) -> list[str]:
        """Return the names of the planted modules that have run so far, and forget them."""
        try:
            return self._log.read_text(encoding="utf-8").split()
        except FileNotFoundError:
            return []
        finally:
            self._log.unlink(missing_ok=True)

    def _module(self, path: Path, name: str) -> None:
        # Import nothing here: imports of this module might be planted, too.
        path.write_text(
            f"with open({str(self._log)!r}, 'a') as log:\n    log.write({name!r} + '\\n')\n", encoding="utf-8"
        )


def write_ranged_study(folder: Path) -> None:
    """Write ``ranged.study`` next to a copy of the pick-and-place example: one scenario with a range of a horizon."""
    model = (folder / "pickplace.bdd").read_text(encoding="utf-8")
    for old, new in (
        ("    var goal\n", "    var goal\n    var shortly\n"),
        ("after <evt-place-end>)", "<shortly> seconds after <evt-place-end>)"),
        ("            variation:\n", "            variation:\n var <pick-place.shortly>: { 0.1 }\n"),
    ):
        assert old in model
        model = model.replace(old, new)
    (folder / "ranged.bdd").write_text(model, encoding="utf-8")
    one = 'where: "thing=cube0 and goal=left_ws" factor var <shortly>: from 0.1 to 0.2 design: grid 2'
    (folder / "ranged.study").write_text(f'import "ranged.bdd" Study ranged {{ {one} }}', encoding="utf-8")
