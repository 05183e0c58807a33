// The way from a page to the extension, and what a page keeps over reloads.

interface Api {
  postMessage(message: object): void;
  getState(): unknown;
  setState(state: object): void;
}

declare function acquireVsCodeApi(): Api;

export interface Host<Outgoing extends object, State extends object> {
  readonly post: (message: Outgoing) => void;
  /** What the page kept in its last life; whoever wrote it was of this page, but perhaps of another version. */
  readonly kept: Partial<State> | undefined;
  readonly keep: (state: State) => void;
}

/** Begin to listen; `receive` gets what the extension, which is of the same version, says. */
export function connect<Outgoing extends object, State extends object>(
  receive: (message: unknown) => void,
): Host<Outgoing, State> {
  const api = acquireVsCodeApi();
  window.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
    receive(data);
  });
  // Whoever asked for the page goes on in this turn; its first message is for after that.
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
