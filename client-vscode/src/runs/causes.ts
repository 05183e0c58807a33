// Which clauses of a scenario are unknown only because of another clause.

/** A verdict with its text. */
export interface Judged {
  readonly verdict: "holds" | "violated" | "unknown";
  /** As in the server's messages: the reason, and in brackets the verdict; empty if it holds. */
  readonly failure: string;
}

interface Cause {
  readonly name: string;
  readonly reason: string;
}

/** The clauses of one scenario, in the order of their verdicts. */
export class Causes {
  private readonly known: Cause[] = [];

  /**
   * Add a clause. If it is a consequence of one before it, return words that name that one. A clause is a consequence if
   * it is unknown for the same reason, or if its reason ends with that of the cause.
   */
  add(name: string, { verdict, failure }: Judged): string | undefined {
    const reason = reasonOf(failure);
    const cause = verdict === "unknown" ? this.known.find((one) => one.name !== name && isReasonFor(one.reason, reason)) : undefined;
    if (cause === undefined && reason !== "") {
      this.known.push({ name, reason });
    }
    if (cause === undefined) {
      return undefined;
    }
    return cause.reason === reason ? `unknown for the same reason as ${cause.name}` : `unknown because of ${cause.name}`;
  }
}

function isReasonFor(cause: string, reason: string): boolean {
  return reason === cause || reason.endsWith(`: ${cause}`);
}

/** The reason in a failure's text; empty if it has only a verdict. */
function reasonOf(failure: string): string {
  return /^(.+) \((?:violated|unknown)[^()]*\)$/s.exec(failure)?.[1] ?? "";
}
