"""The frames of a scenario's elements in a log, and their poses in the world."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.agent.log_mappers import mapped_frames
from robbdd_tools.agent.log_steps import steps_of_frames
from robbdd_tools.catalog.base_frames import BASE_FRAMES
from robbdd_tools.logs.log_contents import Track
from robbdd_tools.logs.log_names import (
    FramesProblem,
    NoElement,
    base_frame_of,
    elements_of,
    frame_of,
    local_name,
    shared_frames,
    stated_frames,
    tool_frame_of,
)
from robbdd_tools.logs.transforms import (
    Unconnected,
    poses_at,
    product,
    reached,
    root_of,
    rotated,
    steadier_poses_at,
)
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.staging import Staging

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.log_contents import LogContents
    from robbdd_tools.protocol.log_request import LogRequest
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.world.cast import Cast
    from robbdd_tools.world.pose import Pose

Poses = tuple["FloatArray", "FloatArray"]
"""Positions (n, 3) m in the frame of the world and orientations (n, 4), w first; NaN where unobserved."""
NAME_WORLD = "name the frame of the world with --world FRAME"
WORLD = "world"
MAX_LISTED = 8
HOLE = 10.0
"""A recording has a hole where this many usual intervals pass without a pose."""
CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


class Frames:
    """The frames of a scenario's elements in a log, and their poses. ``remarks`` gets sentences about missing data.

    ``jointed`` are the agents whose joints the log reports: if the tool has no frame, its poses follow from the joints.
    """

    def __init__(
        self,
        spec: ScenarioSpec,
        cast: Cast,
        contents: LogContents,
        request: LogRequest,
        remarks: list[str],
        jointed: Collection[str],
    ) -> None:
        self._spec = spec
        self._cast = cast
        self._tracks = dict(contents.tracks)
        self._max_gap = request.max_gap
        self._remarks = remarks
        self.of: dict[str, str] = {}
        """Frame of each element."""
        elements = (*cast.objects, *cast.agents, *cast.points)
        mapped = mapped_frames(spec, contents.tracks, elements)
        stated = {**mapped, **stated_frames(spec), **elements_of(request.frames, elements)}
        problems: dict[str, str] = {}
        for element in elements:
            try:
                found = tool_frame_of if element in cast.every_agent else frame_of
                self.of[element] = frame = found(element, contents.tracks, stated)
                if {element, local_name(element)}.isdisjoint(stated) and "/" in frame:
                    remarks.append(f"{element} is the frame '{frame}'")
            except FramesProblem as problem:
                problems[element] = str(problem)
        for element, problem in shared_frames(self.of, stated).items():
            del self.of[element]
            problems[element] = problem
        asked = {agent for agent in jointed if agent not in self.of}
        self._bases = self._base_frames(elements_of(request.bases, cast.agents), asked)
        # Whether a thing is at a place also depends on the workspaces of others, which may be inside this one.
        carriers = {carrier for own in spec.scene.workspaces.values() for carrier in own}
        unused = set(spec.scene.unused) - carriers
        for element, problem in problems.items():
            used = element in (*spec.scene.objects, *spec.scene.agents) and element not in unused
            if used and (element not in jointed or element in stated):
                remarks.append(problem)
        self._stated_world = bool(request.world)
        self._world = _stated_world(request.world, self._tracks) or self._root()
        self._anchor()

    def observed(self) -> list[FloatArray]:
        """Return the times (s) of the moving frames of elements and bases, and of all frames up to their roots."""
        found = sorted(reached((*self.of.values(), *self._bases.values()), self._tracks))
        used = [one for frame in found for one in (self._tracks[frame], *self._tracks[frame].later)]
        return [track.times for track in used if not track.static]

    def steps(self) -> Iterator[str]:
        """Yield a remark on each frame above an agent that steps."""
        used = [self.of[agent] for agent in self._cast.every_agent if agent in self.of]
        yield from steps_of_frames([*used, *self._bases.values()], self._tracks, self._world)

    def holes(self) -> Iterator[str]:
        """Yield a remark on each frame that was not recorded for long, but no longer than is interpolated."""
        for frame in sorted(reached((*self.of.values(), *self._bases.values()), self._tracks)):
            track = self._tracks[frame]
            waits = np.diff(track.times)
            if track.static or not len(waits):
                continue
            usual, row = float(np.median(waits)), int(np.argmax(np.where(waits > self._max_gap, 0.0, waits)))
            if waits[row] > HOLE * usual and usual < waits[row] <= self._max_gap:
                words = f"the frame '{frame}' is recorded every {1000 * usual:.0f} ms, but not for {waits[row]:.2f} s"
                yield f"{words} from {track.times[row]:.2f} s on: what happened there is interpolated"

    def is_stated(self, element: str) -> bool:
        """Return whether the place of an element is stated, by static transforms or the ``.scenex``, not observed.

        What is stated to be on a moving base of an agent, or on the agent, is not observed either: it moves with them.
        """
        frame = self.of.get(element)
        return frame is None or self._is_fixed(frame) or self._is_fixed_to_agent(frame)

    def poses(self, element: str, times: FloatArray) -> Poses | None:
        """Return the poses of an element's frame at some times (n,) s; ``None`` if it has none."""
        return self._poses(self.of[element], times) if element in self.of else None

    def base_poses(self, agent: str, times: FloatArray) -> Poses | None:
        """Return the poses of an agent's base, from the log or else from the ``.scenex``; ``None`` if both have none.

        A remark states which of them was used.
        """
        frame = self._bases.get(agent)
        if frame is not None and (found := self._poses(frame, times)) is not None:
            self._remarks.append(f"the base of {agent} is the frame '{frame}'")
            return found[0], product(found[1], _tilts(self._cast, agent, len(times)) * CONJUGATE)
        pose = self._stated_pose(agent, self._base)
        hint = f"name the frame of its base with --base {local_name(agent)}=FRAME"
        if pose is None:
            self._remarks.append(f"the log and the .scenex do not say where the base of {agent} is: {hint}")
            return None
        if not self._is_world():
            self._remarks.append(f"the .scenex places the base of {agent} in the world: {NAME_WORLD}, or {hint}")
            return None
        self._remarks.append(f"the base of {agent} is where the .scenex places it")
        return _fixed(pose, len(times))

    def object_poses(self, element: str, times: FloatArray) -> Poses | None:
        """Return the poses of an object's centre, from the log or else from the ``.scenex``."""
        if element in self.of:
            found = self.poses(element, times)
            if found is None:
                return None
            place, turn = found
            if not any(offset := self._cast.objects[element].frame):
                return found
            if np.isnan(turn[~np.isnan(place).any(axis=1)]).any():
                away = f"whose centre is {1000 * float(np.linalg.norm(offset)):.0f} mm from its frame"
                self._remarks.append(f"the log does not say how {element}, {away}, is turned: its place is unknown")
            return place - rotated(turn, np.tile(self._cast.objects[element].frame, (len(times), 1))), turn
        pose = self._stated_pose(element, lambda cast, name: cast.pose(name))
        if pose is None:
            return None
        if not self._is_world():
            self._remarks.append(f"{element} is not in the log, and the .scenex places it in the world: {NAME_WORLD}")
            return None
        self._remarks.append(f"{element} is not in the log, so it stands where the .scenex places it")
        return _fixed(pose, len(times))

    def _poses(self, frame: str, times: FloatArray) -> Poses | None:
        try:
            return steadier_poses_at(frame, self._world, self._tracks, times, self._max_gap)
        except Unconnected as problem:
            self._remarks.append(str(problem))
            return None

    def _base_frames(self, stated: Mapping[str, str], asked: Collection[str]) -> dict[str, str]:
        """Return the frames of the bases: stated frames, and frames with the names that drivers of an arm use.

        A remark names each agent of ``asked`` without a base.
        """
        frames = {*self._tracks, *(parent for track in self._tracks.values() for parent in track.parents)}
        found: dict[str, str] = {}
        for agent, robot in self._cast.agents.items():
            try:
                frame = base_frame_of(agent, frames, BASE_FRAMES.get(robot.name, ()), stated.get(agent, ""))
            except FramesProblem as problem:
                self._remarks += [str(problem)] if agent in (*asked, *stated) else []
                continue
            if frame:
                found[agent] = frame
        return found

    def _base(self, cast: Cast, agent: str) -> Pose | None:
        try:
            return cast.base(agent)
        except SceneError as error:
            self._remarks.append(str(error))
            return None

    def _stated_pose(self, element: str, pose_of: Callable[[Cast, str], Pose | None]) -> Pose | None:
        """Return the pose of an element in the ``.scenex``; ``None`` if it states none or samples the pose."""
        if self._spec.instance is None:
            return None
        # A sampled pose differs with another seed.
        other = replace(self._cast, staging=Staging(self._spec.instance, self._spec.seed + 1))
        pose = pose_of(self._cast, element)
        return pose if pose == pose_of(other, element) else None

    def _is_world(self) -> bool:
        """Return whether poses are given in the world of the ``.scenex``, by its name or by the user.

        This is also true if the log has no frame.
        """
        anchor = "" if self._spec.instance is None else self._spec.instance.anchor
        names = {WORLD, "map", local_name(anchor)}
        return self._stated_world or not self._world or local_name(self._world).casefold() in names

    def _root(self) -> str:
        """Return the common root of the frames of elements or, if there are none, of bases."""
        roots: dict[str, str] = {}
        for frame in self.of.values() or self._bases.values():
            try:
                roots.setdefault(root_of(frame, self._tracks), frame)
            except Unconnected as problem:
                self._remarks.append(str(problem))
        if len(roots) > 1:
            listed = ", ".join(f"'{frame}' in '{root}'" for root, frame in roots.items())
            self._remarks.append(f"the frames are not connected: {listed}; {NAME_WORLD}")
        return next(iter(roots), "")

    def _anchor(self) -> None:
        """Use the base of an arm to place a log without a frame of the world in the world of the ``.scenex``."""
        if self._is_world() or self._world in self._tracks:
            return
        for agent, frame in self._bases.items():
            pose = self._stated_pose(agent, self._base)
            if pose is None or not self._is_fixed(frame):
                continue
            place, turn = poses_at(self._world, frame, self._tracks, np.zeros(1), self._max_gap)
            origin, upright = _fixed(pose, 1)
            base = product(upright, _tilts(self._cast, agent, 1))
            self._tracks[self._world] = Track(
                WORLD, np.zeros(1), origin + rotated(base, place), product(base, turn), static=True
            )
            self._world = WORLD
            words = f"'{frame}' is the base of {agent}, which stands where the .scenex places it"
            self._remarks.append(f"the log has no frame of the world: {words}")
            return

    def _is_fixed_to_agent(self, frame: str) -> bool:
        agents = [*(self.of[name] for name in self._cast.every_agent if name in self.of), *self._bases.values()]
        carrying = {*reached(agents, self._tracks)}
        while frame in self._tracks and self._tracks[frame].static:
            frame = self._tracks[frame].parent
            if frame in carrying:
                return True
        return False

    def _is_fixed(self, frame: str) -> bool:
        """Return whether a frame never moves relative to the root of the frames."""
        try:
            if root_of(frame, self._tracks) != self._world:
                return False
        except Unconnected:
            return False
        while frame in self._tracks:
            if not self._tracks[frame].static:
                return False
            frame = self._tracks[frame].parent
        return True


def _tilts(cast: Cast, agent: str, count: int) -> FloatArray:
    """Return the rotation of an agent's base relative to its upright base, repeated, quaternions, shape (count, 4)."""
    return np.tile(cast.agents[agent].tilt, (count, 1))


def _stated_world(stated: str, tracks: Mapping[str, Track]) -> str:
    """Return the stated frame of the world, empty if none is. Raises ``NoElement`` if the log has no such frame."""
    world, known = stated.lstrip("/"), {*tracks, *(parent for track in tracks.values() for parent in track.parents)}
    if world and known and world not in known:
        raise NoElement(f"the log has no frame '{world}' for --world; it has: {', '.join(sorted(known)[:MAX_LISTED])}")
    return world


def _fixed(pose: Pose, count: int) -> Poses:
    """Return a pose of the ``.scenex`` for ``count`` times."""
    upright = (float(np.cos(pose.yaw / 2)), 0.0, 0.0, float(np.sin(pose.yaw / 2)))
    return np.tile(pose.position, (count, 1)), np.tile(pose.rotation or upright, (count, 1))
