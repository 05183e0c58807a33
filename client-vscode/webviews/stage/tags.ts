// Labels in a picture, moved so that none overlaps another.

/** A label's centre and lower edge, and its size, px; y counts downwards. */
export interface Tag {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** The lower edge of each label, px: the lowest stay; an overlapping one is moved just above the other. */
export function apart(tags: readonly Tag[]): number[] {
  const edges = tags.map(({ y }) => y);
  const placed: Tag[] = [];
  for (const [index, tag] of [...tags.entries()].sort(([, one], [, other]) => other.y - one.y)) {
    let { y } = tag;
    // Labels are placed from below upwards, so one pass finds all conflicts.
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
