// When to start a crashed server again.

const WINDOW = 3 * 60 * 1000;
const LIMIT = 3;

/** Allows a few crashes in a while; a server that keeps crashing stays down until somebody asks. */
export class RestartBudget {
  private crashes: number[] = [];

  /** Record a crash at `now` (ms) and say whether the server may be started again. */
  crashed(now: number): boolean {
    this.crashes = [...this.crashes.filter((time) => now - time < WINDOW), now];
    return this.crashes.length <= LIMIT;
  }
}
