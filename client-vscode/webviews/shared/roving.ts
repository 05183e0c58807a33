// Arrow keys within a group of controls that is one stop of the Tab key.

/** The part of a keyboard event that counts. */
interface Key {
  readonly key: string;
  readonly ctrlKey: boolean;
  readonly metaKey: boolean;
  readonly altKey: boolean;
  readonly shiftKey: boolean;
}

/** The place that a key leads to from `place` in a row of `count`; undefined if the key does not move in a row. */
export function nextPlace({ key, ctrlKey, metaKey, altKey, shiftKey }: Key, place: number, count: number): number | undefined {
  if (ctrlKey || metaKey || altKey || shiftKey || count === 0) {
    return undefined;
  }
  switch (key) {
    case "ArrowRight":
      return (place + 1) % count;
    case "ArrowLeft":
      return (Math.max(place, 0) - 1 + count) % count;
    case "Home":
      return 0;
    case "End":
      return count - 1;
    default:
      return undefined;
  }
}
