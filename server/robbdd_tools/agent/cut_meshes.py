"""Cut hollow meshes: ``python -m robbdd_tools.agent.cut_meshes``, with ``find MODEL`` or ``cut MESH THRESHOLD``.

``find`` prints a line for each hollow collision mesh of an MJCF or URDF file: how hollow it is and its path. ``cut``
prints the number of pieces, and their volume as a share of the mesh's. Exit codes: 0 done; 2 the file cannot be used.
"""

from __future__ import annotations

import sys
from pathlib import Path

FAILED = 2


def find(model: Path) -> int:
    """Print the hollow collision meshes of a model."""
    from robbdd_tools.world.model_meshes import hollow_files

    try:
        hollow = hollow_files(model)
    except (ValueError, OSError) as error:
        print(" ".join(str(error).split()), file=sys.stderr)
        return FAILED
    for file, share in hollow.items():
        print(f"{share:.3g}\t{file}")
    return 0


def cut(mesh: Path, threshold: float) -> int:
    """Cut a mesh into pieces."""
    from robbdd_tools.world.mesh_cutting import NotCut, cut_mesh

    try:
        done = cut_mesh(mesh, threshold)
    except NotCut as error:
        print(error, file=sys.stderr)
        return FAILED
    except OSError as error:
        print(f"{error.filename or mesh}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    print(f"{done.pieces}\t{done.share:.3g}")
    return 0


def main(action: str, file: str, threshold: str = "") -> int:
    """Do an action and return the exit code."""
    return find(Path(file)) if action == "find" else cut(Path(file), float(threshold))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
