// Names in a picture, moved so that none covers another.

/** A name's middle and lower edge, and its size, px; y counts downwards. */
export interface Tag {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** The lower edge of each name, px: the lowest stay, one that would cover another stands right above that. */
export function apart(tags: readonly Tag[]): number[] {
  const edges = tags.map(({ y }) => y);
  const placed: Tag[] = [];
  for (const [index, tag] of [...tags.entries()].sort(([, one], [, other]) => other.y - one.y)) {
    let { y } = tag;
    // Those placed come from below upwards, so that one pass meets each that is in the way.
    for (const other of placed) {
      const beside = Math.abs(tag.x - other.x) >= (tag.width + other.width) / 2;
      if (!beside && y > other.y - other.height && y - tag.height < other.y) {
        y = other.y - other.height;
      }
    }
    edges[index] = y;
    placed.push({ ...tag, y });
    placed.sort((one, other) => other.y - one.y);
  }
  return edges;
}
