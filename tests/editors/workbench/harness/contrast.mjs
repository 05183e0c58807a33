// Whether what is shown can be read.

/** Contrast of two colours, as CSS says them, as WCAG 2 defines it: from 1 to 21. */
export function contrast(one, other) {
  const light = (colour) => {
    // What is mixed of colours is said in parts of one.
    const whole = colour.startsWith("color(srgb ") ? 1 : 255;
    const [red, green, blue] = colour.match(/[\d.]+/g).map((part) => {
      const value = Number(part) / whole;
      return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const [darker, lighter] = [light(one), light(other)].sort((a, b) => a - b);
  return (lighter + 0.05) / (darker + 0.05);
}
