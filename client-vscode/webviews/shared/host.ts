// Messages from a page to the extension, and its state over reloads.

interface Api {
  postMessage(message: object): void;
  getState(): unknown;
  setState(state: object): void;
}

declare function acquireVsCodeApi(): Api;

export interface Host<Outgoing extends object, State extends object> {
  readonly post: (message: Outgoing) => void;
  /** The kept state, written by this page, perhaps in another version. */
  readonly kept: Partial<State> | undefined;
  readonly keep: (state: State) => void;
}

/** Start listening; `receive` gets the messages of the extension, which has the same version. */
export function connect<Outgoing extends object, State extends object>(
  receive: (message: unknown) => void,
): Host<Outgoing, State> {
  const api = acquireVsCodeApi();
  window.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
    receive(data);
  });
  // The caller continues in this turn; send the first message after it.
  queueMicrotask(() => {
    api.postMessage({ type: "ready" });
  });
  return {
    post: (message) => {
      api.postMessage(message);
    },
    kept: api.getState() as Partial<State> | undefined,
    keep: (state) => {
      api.setState(state);
    },
  };
}
