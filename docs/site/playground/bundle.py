"""Packs the language core and the libraries that it needs for the playground: ``python bundle.py FOLDER/core.zip``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

ROOT = Path(__file__).parents[3]
PACKAGE = ROOT / "server" / "robbdd_tools"
DATA = ("grammar", "metamodels", "examples")
LIBRARIES = (
    *("rdflib", "pyparsing", "pyshacl", "owlrl", "prettytable", "wcwidth", "packaging"),
    *("Jinja2", "MarkupSafe", "rapidfuzz", "covertable"),
)
"""The libraries of syntax, names, rules, graph and Gherkin; of those with compiled parts, the Python form is used."""
KEPT = (".py", ".ttl", ".json", ".jsonld", ".jinja")
"""Kinds of files of libraries that are needed at run time."""
LEFT = (".pyc", ".png", ".ipynb", ".stl", ".obj")
"""Kinds of files of ours that are not: compiled code, pictures and meshes."""


def entries() -> Iterator[tuple[str, Path]]:
    """Yield each file with its place in the archive."""
    for name in LIBRARIES:
        for file in distribution(name).files or ():
            place = Path(str(file.locate()))
            if (place.suffix in KEPT or place.name == "METADATA") and "tests" not in file.parts and place.is_file():
                yield file.as_posix(), place
    for folder, inside in ((PACKAGE, "robbdd_tools"), *((ROOT / name, f"robbdd_tools/data/{name}") for name in DATA)):
        for place in folder.rglob("*"):
            if place.is_file() and place.suffix not in LEFT:
                yield f"{inside}/{place.relative_to(folder).as_posix()}", place


def pack(archive: Path) -> None:
    """Write the archive. The same files give the same bytes."""
    with ZipFile(archive, "w", ZIP_DEFLATED) as written:
        for name, place in sorted(dict(entries()).items()):
            written.writestr(ZipInfo(name), place.read_bytes(), ZIP_DEFLATED)


if __name__ == "__main__":
    pack(Path(sys.argv[1]))
