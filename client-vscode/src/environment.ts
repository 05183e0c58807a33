// Asks another extension for something that it may refuse, or never answer: neither may keep ours from working.

/** Milliseconds that another extension has to answer. */
export const ANSWER_LIMIT = 5000;

/** What `ask` answers; undefined when it fails or takes longer than the limit, which `warn` gets in words. */
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
    warn(`${what}: ${error instanceof Error ? error.message : String(error)}. It is left out.`);
    return undefined;
  } finally {
    clearTimeout(timer);
  }
}
