"""``python -m robbdd_tools.agent.export_bag RUN INDEX OUT sqlite|mcap``: write a stored trace as a rosbag2."""

from __future__ import annotations

import sys
from pathlib import Path

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.logs.ros2_bag import DrawnScene, write_ros2_bag
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.traces.mcap_file import read_trace, read_views
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.scene import cast_scene
from robbdd_tools.world.staging import Staging


def _main() -> int:
    folder, index, out, storage = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
    spec = read_manifest(folder).scenarios[index]
    try:
        staging = None if spec.instance is None else Staging(spec.instance, spec.seed)
        path = trace_file(folder, index)
        trace = read_trace(path).trace
        cast = cast_scene(spec.scene, staging, of_log=bool(trace.log))
        frames = {name: model.frame for name, model in cast.objects.items()}
        views = read_views(path, ["/joints", "/geometry", "/tf"])
        scene = DrawnScene(views["/geometry"][0][1], views["/tf"]) if views["/geometry"] else None
        write_ros2_bag(out, trace, frames, views["/joints"], scene=scene, mcap=storage == "mcap")
    except (RobbddError, SceneError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(_main())
