// What the camera can follow: tools and movable elements, in words.
import { type Trace, local } from "../../src/panels/replay/answer";

export interface Followed {
  /** Index of the body. */
  readonly body: number;
  readonly words: string;
}

/** The tools of the agents first, then the elements that move; links of robots are left out. */
export function followable({ bodies, frames, tools = [] }: Pick<Trace, "bodies" | "frames" | "tools">): Followed[] {
  const held = tools.map(({ agent, body }) => ({ body, words: `${local(agent)} tool` }));
  const things = frames.bodies.filter((body) => bodies[body] !== undefined && !bodies[body].name.includes("/"));
  return [...held, ...things.map((body) => ({ body, words: local(bodies[body]?.name ?? "") }))];
}
