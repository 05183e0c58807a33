// The visible part of a picture: its point (px, py) is at (x + px·scale, y + py·scale) in the window.

export interface Viewport {
  readonly x: number;
  readonly y: number;
  readonly scale: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

export interface Box extends Size {
  readonly x: number;
  readonly y: number;
}

export const SMALLEST = 0.05;
export const LARGEST = 4;
const MARGIN = 16;

/** Fit the whole picture into the window, centred and not enlarged. */
export function fitted(picture: Size, window: Size, smallest = SMALLEST): Viewport {
  const wide = (window.width - 2 * MARGIN) / picture.width;
  const high = (window.height - 2 * MARGIN) / picture.height;
  const scale = Math.max(smallest, Math.min(1, wide, high));
  const beginning = (space: number, length: number) => Math.max(MARGIN, (space - length * scale) / 2);
  return { x: beginning(window.width, picture.width), y: beginning(window.height, picture.height), scale };
}

/** Zoom by a factor around the window's point (x, y). */
export function zoomed(view: Viewport, factor: number, x: number, y: number): Viewport {
  const scale = Math.min(LARGEST, Math.max(SMALLEST, view.scale * factor));
  const ratio = scale / view.scale;
  return { x: x - (x - view.x) * ratio, y: y - (y - view.y) * ratio, scale };
}

export function panned(view: Viewport, dx: number, dy: number): Viewport {
  return { ...view, x: view.x + dx, y: view.y + dy };
}

/** Show a box of the picture in the middle of the window; a larger box from its start. */
export function centred(view: Viewport, box: Box, window: Size): Viewport {
  const place = (start: number, length: number, space: number) => {
    return length * view.scale > space - 2 * MARGIN ? MARGIN - start * view.scale : (space - length * view.scale) / 2 - start * view.scale;
  };
  return { ...view, x: place(box.x, box.width, window.width), y: place(box.y, box.height, window.height) };
}

/** Pan as little as needed to show a box of the picture; a larger box is shown from its start. */
export function revealed(view: Viewport, box: Box, window: Size): Viewport {
  const move = (start: number, length: number, space: number) => {
    if (start < MARGIN || length > space - 2 * MARGIN) {
      return MARGIN - start;
    }
    return Math.min(0, space - MARGIN - (start + length));
  };
  return panned(
    view,
    move(view.x + box.x * view.scale, box.width * view.scale, window.width),
    move(view.y + box.y * view.scale, box.height * view.scale, window.height),
  );
}
