// Measure the contrast of shown text.

/** Contrast of two colours, as CSS says them, as WCAG 2 defines it: from 1 to 21. */
export function contrast(one, other) {
  const ground = parts(other);
  const light = (colour) => {
    const { alpha, values } = parts(colour);
    const [red, green, blue] = values.map((part, index) => {
      // What can be seen through is seen on the other.
      const value = part * alpha + ground.values[index] * (1 - alpha);
      return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const [darker, lighter] = [light(one), light(other)].sort((a, b) => a - b);
  return (lighter + 0.05) / (darker + 0.05);
}

/** Red, green and blue from 0 to 1, and how much they cover. */
function parts(colour) {
  // What is mixed of colours is said in parts of one.
  const whole = colour.startsWith("color(srgb ") ? 1 : 255;
  const [red, green, blue, alpha = 1] = colour.match(/[\d.]+/g).map(Number);
  return { alpha, values: [red, green, blue].map((part) => part / whole) };
}
