// A picture of the moment to paste elsewhere: the scene, and what is shown there in words.
import { element } from "../shared/elements";

const EDGE = 10;
const LINE = 18;
const SIZE = 13;

/** Put lines of words below a picture with `ratio` pixels per px. */
export function captioned(scene: HTMLCanvasElement, words: readonly string[], ratio: number): HTMLCanvasElement {
  const band = (words.length * LINE + 2 * EDGE) * ratio;
  const picture = element("canvas", { width: scene.width, height: scene.height + band });
  const into = picture.getContext("2d");
  if (into !== null) {
    const { color, backgroundColor, fontFamily } = getComputedStyle(document.body);
    into.fillStyle = backgroundColor;
    into.fillRect(0, 0, picture.width, picture.height);
    into.drawImage(scene, 0, 0);
    into.fillStyle = color;
    into.textBaseline = "top";
    into.font = `${SIZE * ratio}px ${fontFamily}`;
    for (const [index, text] of words.entries()) {
      into.fillText(text, EDGE * ratio, scene.height + (EDGE + index * LINE) * ratio, picture.width - 2 * EDGE * ratio);
    }
  }
  return picture;
}

/** Copy a picture; false where the page may not, as without the focus or in an older browser. */
export async function copied(picture: HTMLCanvasElement): Promise<boolean> {
  const made = new Promise<Blob>((resolve, reject) => {
    picture.toBlob((blob) => {
      if (blob === null) {
        reject(new Error("the picture is empty"));
      } else {
        resolve(blob);
      }
    }, "image/png");
  });
  try {
    await navigator.clipboard.write([new ClipboardItem({ "image/png": made })]);
    return true;
  } catch (error) {
    console.warn(error);
    return false;
  }
}

/** A picture as PNG in base64. */
export function encoded(picture: HTMLCanvasElement): string {
  return picture.toDataURL("image/png").replace(/^.*,/, "");
}
