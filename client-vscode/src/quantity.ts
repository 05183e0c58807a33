// Margins for display.

/** A signed margin in a readable unit: +20 mm, −0.4 rad. */
export function signed(value: number, unit: string): string {
  const short = unit === "m" && Math.abs(value) < 1;
  const [number, shown] = short ? [value * 1000, "mm"] : [value, unit];
  const size = Math.abs(number);
  const digits = size >= 1000 ? size.toFixed(0) : size.toPrecision(3);
  return `${number < 0 ? "−" : "+"}${digits} ${shown}`.trimEnd();
}
