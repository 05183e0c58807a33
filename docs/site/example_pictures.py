"""Draws the scene of each example into ``docs/images/examples``: ``.venv/bin/python docs/site/example_pictures.py``.

Names of examples as arguments draw only these. Graphics and Pillow (extra ``video``) are needed.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "images" / "examples"
SIZE = (640, 400)
COLOURS = 96
"""Size of the palette: the pages of all examples stay small."""


def draw(example: Path) -> None:
    """Draw the first scenario of an example, where there is an execution with its scene instance."""
    models = [*sorted(example.glob("*.bddx")), *sorted(example.glob("*.bdd"))]
    with tempfile.TemporaryDirectory() as folder:
        drawn = Path(folder) / "scene.png"
        subprocess.run([Path(sys.executable).with_name("robbdd"), "view", models[0], "-o", drawn], check=True)
        with Image.open(drawn) as picture:
            small = picture.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)
    small.quantize(COLOURS).save(PICTURES / f"{example.name}.png", optimize=True)


if __name__ == "__main__":
    wanted = set(sys.argv[1:])
    PICTURES.mkdir(exist_ok=True)
    for found in sorted({path.parent for path in (ROOT / "examples").glob("*/*.bdd")}):
        if not wanted or found.name in wanted:
            draw(found)
