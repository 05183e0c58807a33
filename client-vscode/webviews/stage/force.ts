// Contact forces, as they are shown in a scene.

/** A contact force now. The trace has its size, but neither its direction nor its point. */
export interface Force {
  /** The bodies in contact. */
  readonly between: readonly [number, number];
  /** "ur10 – bin 12.3 N" */
  readonly words: string;
}
