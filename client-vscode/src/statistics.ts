// Statistics of executions.

/** Normal quantile of a two-sided interval of 95 %. */
const Z = 1.959963984540054;

/**
 * Wilson's score interval of 95 % for the probability that an execution holds (E. B. Wilson, 1927), as numbers from 0 to 1.
 * It assumes independent executions. An unknown one may be either: the interval covers both.
 */
export function wilson(holding: number, total: number, unknown = 0): readonly [low: number, high: number] {
  return [bound(holding, total, -1), bound(holding + unknown, total, 1)];
}

/** "43–97 %" */
export function intervalWords(holding: number, total: number, unknown = 0): string {
  const [low, high] = wilson(holding, total, unknown).map((share) => Math.round(share * 100));
  return `${low}–${high} %`;
}

function bound(holding: number, total: number, side: 1 | -1): number {
  // Rounding would miss the ends, and without executions nothing is known.
  if (total === 0 || holding === (side < 0 ? 0 : total)) {
    return side < 0 ? 0 : 1;
  }
  const share = holding / total;
  const spread = Z * Math.sqrt((share * (1 - share)) / total + (Z / (2 * total)) ** 2);
  return (share + Z ** 2 / (2 * total) + side * spread) / (1 + Z ** 2 / total);
}
