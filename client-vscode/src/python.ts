// The only module that talks to the Python extension, which may be absent.
import * as vscode from "vscode";
import { answerOf } from "./environment";

const PYTHON_EXTENSION = "ms-python.python";

/** The used part of the Python extension's public interface. */
interface PythonApi {
  readonly environments: {
    getActiveEnvironmentPath(resource?: vscode.Uri): { readonly path: string };
    resolveEnvironment(path: { readonly path: string }): Promise<
      { readonly executable: { readonly uri: vscode.Uri | undefined } } | undefined
    >;
    readonly onDidChangeActiveEnvironmentPath: vscode.Event<unknown>;
  };
}

/** The interpreter selected for a workspace folder; undefined without the Python extension or a selection. */
export async function selectedInterpreter(
  folder: vscode.Uri | undefined,
  log: vscode.LogOutputChannel,
): Promise<string | undefined> {
  const api = await pythonApi(log);
  if (api === undefined) {
    return undefined;
  }
  const { environments } = api;
  const environment = await answerOf(
    "The Python extension did not report the selected environment",
    () => environments.resolveEnvironment(environments.getActiveEnvironmentPath(folder)),
    (message) => {
      log.warn(message);
    },
  );
  return environment?.executable.uri?.fsPath;
}

/** Call `listener` whenever another interpreter is selected. */
export async function onInterpreterChange(
  listener: () => void,
  log: vscode.LogOutputChannel,
): Promise<vscode.Disposable | undefined> {
  return (await pythonApi(log))?.environments.onDidChangeActiveEnvironmentPath(listener);
}

async function pythonApi(log: vscode.LogOutputChannel): Promise<PythonApi | undefined> {
  const extension = vscode.extensions.getExtension<Partial<PythonApi> | undefined>(PYTHON_EXTENSION);
  const api = await answerOf(
    "The Python extension could not be started",
    () => extension?.activate(),
    (message) => {
      log.warn(message);
    },
  );
  return api?.environments === undefined ? undefined : { environments: api.environments };
}
