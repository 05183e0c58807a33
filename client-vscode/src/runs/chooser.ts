// Ask for the options of a run, and remember them for each workspace folder.
import * as vscode from "vscode";
import { withoutIcons } from "../literal";
import { type Amount, type OptionName, type RunOptions, argumentsOf, extentIn, numberProblem, optionsIn, substitutionProblem, summaryOf, typedNumber, withOption, wordsOf } from "./options";

const KEY = "robbdd.runOptions";
const TITLE = "Run with Options";

interface Entry extends vscode.QuickPickItem {
  readonly action: OptionName | "run" | "reset";
}

export class RunOptionsChooser {
  /** `estimate` asks the server for the extent of a run, given the arguments of `robbdd.run`. */
  constructor(
    private readonly memory: vscode.Memento,
    private readonly estimate: (target: Readonly<Record<string, unknown>>) => Promise<unknown>,
  ) {}

  /**
   * Ask for the options of a run of a model; undefined if the user cancels. They are remembered either way. `parts` are
   * further arguments of `robbdd.run` for each file, such as the selected tests; the extent of several files is not shown.
   */
  async choose(model: vscode.Uri, parts: readonly Readonly<Record<string, unknown>>[] = [{}]): Promise<RunOptions | undefined> {
    const key = `${KEY}:${folderOf(model)}`;
    const [part, ...others] = parts;
    let options = optionsIn(this.memory.get(key));
    for (;;) {
      const target = { ...part, ...argumentsOf(options), uri: model.toString() };
      const chosen = await ask(options, others.length > 0 ? undefined : this.estimate(target));
      if (chosen === undefined || chosen.action === "run") {
        return chosen && options;
      }
      options = chosen.action === "reset" ? {} : await change(options, chosen.action);
      await this.memory.update(key, options);
    }
  }
}

/**
 * Ask which option to change, or whether to run; undefined if the user cancels. How many executions a run has and how long
 * they take, or why there would be none, is in the title when the server's answer is there: a large model needs some time.
 */
function ask(options: RunOptions, estimate: Promise<unknown> | undefined): Promise<Entry | undefined> {
  const list = vscode.window.createQuickPick<Entry>();
  list.title = TITLE;
  list.placeholder = "Enter runs; choose an option to change it";
  list.items = entries(options);
  list.busy = estimate !== undefined;
  return new Promise((resolve) => {
    let isOpen = true;
    list.onDidAccept(() => {
      resolve(list.selectedItems[0]);
      list.hide();
    });
    list.onDidHide(() => {
      isOpen = false;
      resolve(undefined);
      list.dispose();
    });
    list.show();
    void estimate?.then((answer) => {
      if (isOpen) {
        // Not at an entry: the editor would choose the first one again, whichever the user has reached.
        const extent = extentIn(answer);
        list.title = extent === undefined ? TITLE : `${TITLE}: ${extent}`;
        list.busy = false;
      }
    });
  });
}

function folderOf(model: vscode.Uri): string {
  return vscode.workspace.getWorkspaceFolder(model)?.uri.toString() ?? "";
}

function entries(options: RunOptions): Entry[] {
  const summary = summaryOf(options);
  const option = (label: string, action: OptionName): Entry => ({ label, description: withoutIcons(wordsOf(options, action)), action });
  return [
    { label: "$(play) Run", description: withoutIcons(summary), action: "run" },
    option("$(filter) Values", "where"),
    option("$(list-filter) Scenarios", "amount"),
    option("$(sync) Repetitions", "repeat"),
    option("$(symbol-numeric) Seed", "seed"),
    option("$(server-process) Processes", "jobs"),
    option("$(replace) Behaviours", "bhv"),
    option("$(symbol-structure) Executable Scene", "scenex"),
    option("$(device-camera) Pictures", "record"),
    ...(Object.keys(options).length === 0 ? [] : [{ label: "$(discard) Reset", description: "reset all to the model's values", action: "reset" } as const]),
  ];
}

/** Ask for one option; nothing changes if the user cancels. */
async function change(options: RunOptions, name: OptionName): Promise<RunOptions> {
  switch (name) {
    case "where": {
      const prompt = "Only scenarios with these values, such as: robot=panda and target=~cube.*";
      const typed = await vscode.window.showInputBox({ title: TITLE, prompt, value: options.where ?? "" });
      return typed === undefined ? options : withOption(options, name, typed.trim());
    }
    case "amount":
      return changeAmount(options);
    case "repeat":
      return changeNumber(options, name, "How often should each scenario be executed?");
    case "seed":
      return changeNumber(options, name, "The seed of all random choices; it replaces the seeds of executions.", Number.MIN_SAFE_INTEGER);
    case "jobs":
      return changeNumber(options, name, "How many scenarios should be executed in parallel?");
    case "bhv": {
      const prompt = "Catalog behaviours instead of implementations of the .bddx, such as: my-ros-server=pick-place";
      const typed = await vscode.window.showInputBox({ title: TITLE, prompt, value: options.bhv ?? "", validateInput: substitutionProblem });
      return typed === undefined ? options : withOption(options, name, typed.trim());
    }
    case "scenex": {
      const prompt = "A .scenex for scenarios without an execution: its path, absolute or from the model's folder";
      const typed = await vscode.window.showInputBox({ title: TITLE, prompt, value: options.scenex ?? "" });
      return typed === undefined ? options : withOption(options, name, typed.trim());
    }
    case "record":
      return withOption(options, name, options.record === true ? undefined : true);
  }
}

async function changeNumber(options: RunOptions, name: "repeat" | "seed" | "jobs", prompt: string, least = 1): Promise<RunOptions> {
  const typed = await askNumber(prompt, options[name], least);
  return typed === undefined ? options : withOption(options, name, typedNumber(typed));
}

async function changeAmount(options: RunOptions): Promise<RunOptions> {
  const { amount } = options;
  const kinds: readonly (vscode.QuickPickItem & { readonly amount?: Amount })[] = [
    { label: "All scenarios" },
    { label: "The first …", amount: { kind: "first", number: 10 } },
    { label: "A random sample of …", amount: { kind: "sample", number: 10 } },
    { label: "All combinations of 2 variables", amount: { kind: "pairwise", number: 2 } },
    { label: "All combinations of 3 variables", amount: { kind: "pairwise", number: 3 } },
  ];
  const chosen = await vscode.window.showQuickPick(kinds, { title: TITLE, placeHolder: "Which scenarios?" });
  if (chosen?.amount === undefined || chosen.amount.kind === "pairwise") {
    return chosen === undefined ? options : withOption(options, "amount", chosen.amount);
  }
  const { kind, number } = chosen.amount;
  const typed = await askNumber("How many?", amount?.kind === kind ? amount.number : number, 1);
  const typedAmount = typed === undefined ? undefined : typedNumber(typed);
  return typedAmount === undefined ? options : withOption(options, "amount", { kind, number: typedAmount });
}

function askNumber(prompt: string, value: number | undefined, least: number): Thenable<string | undefined> {
  return vscode.window.showInputBox({
    title: TITLE,
    prompt: `${prompt} Leave it empty to use the model's value.`,
    value: value === undefined ? "" : String(value),
    validateInput: (text) => numberProblem(text, least),
  });
}
