// Margins for display.

/** A signed margin in a readable unit: +20 mm, −0.4 rad. */
export function signed(value: number, unit: string): string {
  const short = unit === "m" && Math.abs(value) < 1;
  const [number, shown] = short ? [value * 1000, "mm"] : [value, unit];
  return `${number < 0 ? "−" : "+"}${Math.abs(number).toPrecision(3)} ${shown}`.trimEnd();
}
