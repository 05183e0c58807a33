// Text of users in places where the editor reads icons, links or control sequences.

const ICON = /\$\([A-Za-z0-9-]+(?:~[A-Za-z]+)?\)/g;
const CONTROL = /[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u2028\u2029]/g;

/** A text for a label, in which the editor would draw `$(bug)` as an icon: it shows these letters. */
export function withoutIcons(text: string): string {
  return text.replace(ICON, "\\$&");
}

/** A text for a notification, in which the editor would turn `[words](command:…)` into a link: it shows these letters. */
export function withoutLinks(text: string): string {
  // A zero-width space, which nobody sees, keeps the two parts of a link from being one.
  return text.replaceAll("](", "]\u200b(");
}

/** Lines for a terminal, which would act on control characters: each is shown as its number. */
export function withoutControls(lines: string): string {
  return lines.replaceAll("\r\n", "\n").replace(CONTROL, (found) => `\\x${found.charCodeAt(0).toString(16).padStart(2, "0")}`).replaceAll("\n", "\r\n");
}
