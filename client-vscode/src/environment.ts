// Query other extensions, which may refuse or never answer, without blocking ours.

/** Time limit for another extension's answer, ms. */
export const ANSWER_LIMIT = 5000;

/** Return the answer of `ask`; undefined if it fails or exceeds the limit, which is reported to `warn`. */
export async function answerOf<Answer>(
  what: string,
  ask: () => PromiseLike<Answer> | Answer,
  warn: (message: string) => void,
  limit: number = ANSWER_LIMIT,
): Promise<Answer | undefined> {
  let timer: NodeJS.Timeout | undefined;
  const late = new Promise<never>((_, reject) => {
    timer = setTimeout(() => {
      reject(new Error(`there was no answer within ${limit / 1000} s`));
    }, limit);
  });
  try {
    return await Promise.race([Promise.resolve().then(ask), late]);
  } catch (error) {
    warn(`${what}: ${error instanceof Error ? error.message : String(error)}. It is ignored.`);
    return undefined;
  } finally {
    clearTimeout(timer);
  }
}
