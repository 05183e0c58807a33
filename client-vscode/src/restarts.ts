// Policy for restarting a crashed server.

const WINDOW = 3 * 60 * 1000;
const LIMIT = 3;

/** Allows a few crashes within a period; a server that keeps crashing stays down until the user restarts it. */
export class RestartBudget {
  private crashes: number[] = [];

  /** Record a crash at `now` (ms) and return whether the server may be restarted. */
  crashed(now: number): boolean {
    this.crashes = [...this.crashes.filter((time) => now - time < WINDOW), now];
    return this.crashes.length <= LIMIT;
  }
}
