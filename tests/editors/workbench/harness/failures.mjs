// A workspace of failures of different kinds: one model each, with the words that a person must see beside its clause.
import { writeFile } from "node:fs/promises";
import { join } from "node:path";

const NAMESPACE = "https://example.org/robbdd/failures/";
/** The execution file that runs every model once. */
export const EXECUTIONS = "failures.bddx";
const PLACED = "placed: holds(<thing> is located at <goal>, after <evt-place-end>)";
const WAITING = ["timeout: 2 seconds"];

/** As many as leave no room in a bin. */
const BALLS = Array.from({ length: 8 }, (_, number) => `ball${number}`);

/**
 * - `then`: the clause after the behaviour; `given`: one before it; `values`: those of variables beside the four usual ones.
 * - `behaviour`: the class of `acting.py` that executes it; `instance`: the scene instance; `policy`: the function that
 *   judges the clause; `settings`: further lines of the execution.
 * - `line`: what the line with the cause reads; `cause`: how the message there begins; `margin`: how the words before a
 *   clause begin, if they say less than the message.
 */
export const FAILURES = {
  "no-room": {
    given: `(\n${BALLS.map((ball) => `            with-${ball}: holds(<${ball}> is located at <goal>, before <evt-pick-start>)`).join(" and\n")}\n        )`,
    values: Object.fromEntries(BALLS.map((ball) => [ball, `{ <balls.${ball}> }`])),
    line: /with-ball0:/,
    cause: /^there is no room left for 'ball\d' at '\w+' among \d other objects \(unknown\)/,
  },
  unreachable: { instance: "far_sim", line: /Behaviour/, cause: /^panda cannot reach a free place at left_ws: its tool stays \d+ mm short \(violated/ },
  "lost-grip": {
    given: "heavy: holds(<thing> has config mass = <weight>, before <evt-pick-start>)",
    values: { weight: "{ 10 }" },
    line: /Behaviour/,
    cause: /^gripper lost cube0 at \d+\.\d\d s/,
  },
  force: {
    then: "gentle: holds(<robot> presses <thing> with less than 1 N, from <evt-pick-start> until <evt-place-end>)",
    line: /gentle:/,
    cause: /^violated by −\d[\d.]* N at \d+\.\d\d s/,
    margin: /^✗ −\d[\d.]* N at \d+\.\d\d s/,
  },
  "time-limit": { behaviour: "Waits", settings: WAITING, line: /Behaviour/, cause: /^the execution was stopped after 2 s of simulated time/ },
  "policy-raises": { policy: "raises", line: /placed:/, cause: /^KeyError: 'gaol' \(acting\.py, line \d+\)/ },
  "behaviour-raises": { behaviour: "Raises", line: /Behaviour/, cause: /^KeyError: 'gaol' \(acting\.py, line \d+\)/ },
  "not-a-number": { behaviour: "Diverges", line: /Behaviour/, cause: /^ValueError: joints must be 7 finite numbers/ },
  "no-model": { instance: "broken_sim", line: /Behaviour/, cause: /^there is no model file .*missing\.xml \(bench\.scenex, line \d+\)/, margin: /^\? unknown: there is no model file / },
  killed: { behaviour: "Dies", line: /Behaviour/, cause: /^the process ended with signal SIGKILL/ },
  "no-event": { behaviour: "Silent", line: /placed:/, cause: /^event evt-place-end never occurred/ },
  deadline: {
    then: "soon: holds(<thing> is located at <goal>, within 1 seconds after <evt-pick-start>)",
    line: /soon:/,
    cause: /^it held at no time until \d+\.\d\d s, .* \(violated by −\d+ mm at \d+\.\d\d s\)/,
  },
  margin: {
    then: "early: holds(<thing> is located at <goal>, after <evt-pick-end>)",
    line: /early:/,
    cause: /^violated by −\d+ mm at \d+\.\d\d s/,
    margin: /^✗ −\d+ mm at \d+\.\d\d s/,
  },
  "no-step": { then: "'the lamp is green' after <evt-place-end>", line: /the lamp/, cause: /^no step definition for 'the lamp is green/, margin: /^\? unknown no step definition: / },
};

const CODE = `"""Behaviours and evaluators that fail, each in its own way."""

import os
import signal


class Waits:
    def reset(self, world, behaviour, arguments):
        self.world = world
        world.emit("pick-start")

    def step(self):
        return False


class Raises(Waits):
    def step(self):
        return {"goal": False}["gaol"]


class Diverges(Waits):
    def step(self):
        self.world.command(self.world.joints * float("nan"), 1.0)
        return False


class Dies(Waits):
    def step(self):
        os.kill(os.getpid(), signal.SIGKILL)


class Silent(Waits):
    def step(self):
        return True


def raises(evidence, arguments):
    return evidence.position(arguments["gaol"])
`;

const SCENE = `ns env = '${NAMESPACE}environment/'

similar obj set (ns=env) cubes { base name: cube count: 1 }
similar obj set (ns=env) balls { base name: ball count: ${BALLS.length} }
obj set (ns=env) furniture { object table, object bin_left }
ws set (ns=env) places { workspace table_ws, workspace left_ws }
agn set (ns=env) arms { agent panda }
comp (ns=env) left_bin of ws <places.left_ws> { obj <furniture.bin_left> }
comp (ns=env) bench of ws <places.table_ws> {
    obj <furniture.table>
    ws comp <left_bin>
}
scene (ns=env) bench_scene {
    obj set <cubes>
    obj set <balls>
    ws comp <bench>
    ws comp <left_bin>
    agn set <arms>
}
`;

/** Write the workspace into a folder. */
export async function writeFailures(folder) {
  const instances = [instance("bench_sim"), instance("far_sim", FAR), instance("broken_sim", "", `sys path = 'missing.xml'`)];
  const head = `import "bench.scene"\n\nns sim = '${NAMESPACE}simulation/'\n\n`;
  const files = { "bench.scene": SCENE, "bench.scenex": head + instances.join("\n"), "acting.py": CODE, [EXECUTIONS]: executions() };
  for (const [name, failure] of Object.entries(FAILURES)) {
    files[`${name}.bdd`] = model(name, failure);
  }
  await Promise.all(Object.entries(files).map(([name, text]) => writeFile(join(folder, name), text)));
}

/** The bin at a place that no arm reaches. */
const FAR = `    kgraph (ns=sim) poses {
        body room { frame origin { } }
        body bin {
            frame bottom {
                pose bin_in_room {
                    wrt: <room.origin>
                    xyz: (0.5, 3, 0.1) m
                    orientation: quat { xyzw: (0, 0, 0, 1) }
                }
            }
        }
    }
`;

function instance(name, poses = "", cube = `catalog "cube"`) {
  const bin = poses === "" ? `catalog "bin"` : `catalog "bin" map body <poses.bin> to "bin"`;
  return `scene inst (ns=sim) ${name} {
    scene: <bench_scene>
${poses}    obj set <cubes> { model ${name}_cube as mjcf { ${cube} } }
    obj set <balls> { model ${name}_ball as mjcf { catalog "ball" } }
    obj <furniture.table> { model ${name}_table as mjcf { catalog "table" } }
    obj <furniture.bin_left> { model ${name}_bin as mjcf { ${bin} } }
    agn <arms.panda> { model ${name}_panda as mjcf { catalog "franka-panda" } }
}
`;
}

function model(name, { given, then = PLACED, values = {} }) {
  const extra = Object.keys(values);
  return `// A failure on purpose: ${name}.
import "bench.scene"

ns t = '${NAMESPACE}${name}/'

Task (ns=t) moving
Event (ns=t) evt-start
Event (ns=t) evt-pick-start
${then.includes("evt-pick-end") ? "Event (ns=t) evt-pick-end\n" : ""}Event (ns=t) evt-place-end
Event (ns=t) evt-end

Scenario Template (ns=t) ${name}-move {
    duration: from <evt-start> until <evt-end>
    task: <moving>

    var thing
    var robot
    var goal
${extra.map((variable) => `    var ${variable}\n`).join("")}
${given === undefined ? "" : `    Given:\n        ${given}\n`}    When:
        Behaviour (ns=t) carry {
            duration: from <evt-pick-start> until <evt-place-end>
            <robot> picks <thing> and places at <goal>
        }
    Then:
        ${then}
}

User Story (ns=t) ${name}-story {
    As A "tester"
    I Want "this to fail"
    So That "the cause can be read"

    Scenarios:
        Scenario ${name} {
            template: <${name}-move>
            scene: <bench_scene>

            variation:
                var <${name}-move.thing>: { <cubes.cube0> }
                var <${name}-move.robot>: { <arms.panda> }
                var <${name}-move.goal>: { <places.left_ws> }
${extra.map((variable) => `                var <${name}-move.${variable}>: ${values[variable]}\n`).join("")}        }
}
`;
}

const OBSERVED = `obs provider (ns=exec) truth { simulation ground truth update-rate: 100 Hz }
observation (ns=exec) thing-pose {
    provider: <truth>
    observes var <policy-raises-move.thing>
}
`;

function executions() {
  const found = Object.entries(FAILURES).map(([name, failure]) => execution(name, failure));
  const imports = Object.keys(FAILURES).map((name) => `import "${name}.bdd"\n`);
  return `${imports.join("")}import "bench.scenex"\n\nns exec = '${NAMESPACE}execution/'\n\n${OBSERVED}\n${found.join("\n")}`;
}

function execution(name, { instance: chosen = "bench_sim", behaviour, policy, settings = [] }) {
  const code = behaviour === undefined ? `catalog "pick-place"` : `py { module: acting, attr: ${behaviour} }`;
  const judged = policy === undefined ? "" : `obs policy (ns=exec) judge-${name} for <${name}-move.placed> {
    observations: { <thing-pose> }
    evaluator: py { module: acting, attr: ${policy} }
}
`;
  return `bhv impl (ns=exec) do-${name} { ${code} }
${judged}Scenario Exec (ns=exec) run-${name} {
    variant: <${name}-story.${name}>
    scene inst: <${chosen}>
    bhv: <do-${name}>
${policy === undefined ? "" : `    policies: { <judge-${name}> }\n`}    seed: 1
${settings.map((line) => `    ${line}\n`).join("")}}
`;
}
