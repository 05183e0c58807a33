// Contact forces at any time of a trace, for the scene.
import { type Trace, local } from "../../src/panels/replay/answer";
import { floats } from "../stage/arrays";
import type { Force } from "../stage/force";

/** Forces below are the numerical remains of a contact, N. */
const FELT = 0.05;

export class Pressed {
  private readonly times: Float32Array;
  private readonly pairs: readonly { readonly names: string; readonly bodies: readonly [number, number]; readonly peaks: Float32Array }[];

  constructor({ frames, forces }: Pick<Trace, "frames" | "forces">) {
    this.times = floats(frames.times);
    this.pairs = (forces ?? []).flatMap(({ between, bodies: [first, second], peaks }) => {
      const [one, other] = [first ?? second, second ?? first];
      // What has no body, such as the ground, is shown at the other one.
      return one === null || other === null ? [] : [{ names: between.map(local).join(" – "), bodies: [one, other] as const, peaks: floats(peaks) }];
    });
  }

  /** Whether any force was recorded. */
  get any(): boolean {
    return this.pairs.length > 0;
  }

  /** The forces in the picture that is shown at a time (s), the largest first. */
  at(time: number): Force[] {
    const after = this.times.findIndex((stamp) => stamp > time);
    const row = Math.max(0, (after < 0 ? this.times.length : after) - 1);
    return this.pairs
      .map(({ names, bodies, peaks }) => ({ between: bodies, size: peaks[row] ?? 0, names }))
      .filter(({ size }) => size >= FELT)
      .sort((one, other) => other.size - one.size)
      .map(({ between, size, names }) => ({ between, words: `${names} ${size.toPrecision(3)} N` }));
  }
}
