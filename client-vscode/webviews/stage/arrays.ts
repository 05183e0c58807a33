// Unpack the numbers of a trace.
import type { PackedArray } from "../../src/panels/replay/answer";

/** The numbers of an array of 32-bit floats. */
export function floats({ data }: PackedArray): Float32Array {
  return new Float32Array(bytes(data));
}

/** The numbers of an array of 32-bit integers. */
export function integers({ data }: PackedArray): Uint32Array {
  return new Uint32Array(bytes(data));
}

/** The arrays are little-endian, as is every machine that shows web views. */
function bytes(data: string): ArrayBuffer {
  return Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer;
}
