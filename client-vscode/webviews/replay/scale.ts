// Scales and label layout of the timeline and the plot.

/** Linear map from values to positions. */
export interface Scale {
  (value: number): number;
  readonly back: (place: number) => number;
}

export function scale(from: number, to: number, start: number, end: number): Scale {
  const span = to - from || 1;
  const length = end - start || 1;
  return Object.assign((value: number) => start + ((value - from) / span) * length, {
    back: (place: number) => from + ((place - start) / length) * span,
  });
}

/** About `count` round values from `from` to `to`: steps of 1, 2 or 5 times a power of ten. */
export function ticks(from: number, to: number, count: number): number[] {
  const rough = (to - from) / Math.max(1, count);
  if (!(rough > 0)) {
    return [from];
  }
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10);
  const first = Math.ceil(from / step - 1e-9);
  const last = Math.floor(to / step + 1e-9);
  // Multiples of the step, written with as many decimals as it has: no 0.30000000000000004.
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return Array.from({ length: last - first + 1 }, (_, index) => Number(((first + index) * step).toFixed(digits)));
}

export interface Label {
  readonly start: number;
  readonly width: number;
}

/** The lane of each label, from 0, so that none overlaps another; labels are ordered by their start. */
export function lanes(labels: readonly Label[]): number[] {
  const ends: number[] = [];
  return labels.map(({ start, width }) => {
    const free = ends.findIndex((end) => end <= start);
    const lane = free < 0 ? ends.length : free;
    ends[lane] = start + width;
    return lane;
  });
}
