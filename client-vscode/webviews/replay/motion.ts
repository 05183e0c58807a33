// Poses of the moving bodies at any time of a trace.
import type { Trace } from "../../src/panels/replay/answer";
import { floats } from "../stage/arrays";

/** Length of a pose: x, y, z (m), then w, x, y, z. */
const POSE = 7;

export class Motion {
  private readonly times: Float32Array;
  private readonly poses: Float32Array;
  /** The indices of the moving bodies. */
  readonly bodies: readonly number[];

  constructor({ frames }: Pick<Trace, "frames">) {
    this.times = floats(frames.times);
    this.poses = floats(frames.poses);
    this.bodies = frames.bodies;
  }

  /**
   * Pass the pose of each moving body at a time (s): x, y, z, then w, x, y, z of unit length. Interpolated between
   * frames, constant before the first and after the last.
   */
  at(time: number, tell: (body: number, pose: readonly number[]) => void): void {
    const after = this.times.findIndex((stamp) => stamp > time);
    const later = after < 0 ? this.times.length - 1 : after;
    const earlier = Math.max(0, after < 0 ? later : later - 1);
    const [from, to] = [this.times[earlier] ?? 0, this.times[later] ?? 0];
    const share = to > from ? Math.min(1, Math.max(0, (time - from) / (to - from))) : 0;
    for (const [column, body] of this.bodies.entries()) {
      tell(body, between(this.pose(earlier, column), this.pose(later, column), share));
    }
  }

  private pose(row: number, column: number): Float32Array {
    const start = (row * this.bodies.length + column) * POSE;
    return this.poses.subarray(start, start + POSE);
  }
}

/** Interpolate two poses; rotations take the shorter way. */
function between(one: Float32Array, other: Float32Array, share: number): number[] {
  const product = [3, 4, 5, 6].reduce((sum, index) => sum + (one[index] ?? 0) * (other[index] ?? 0), 0);
  const mixed = Array.from(one, (value, index) => {
    const sign = index >= 3 && product < 0 ? -1 : 1;
    return value + (sign * (other[index] ?? 0) - value) * share;
  });
  const length = Math.hypot(...mixed.slice(3)) || 1;
  return mixed.map((value, index) => (index < 3 ? value : value / length));
}
