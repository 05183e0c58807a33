// Packs the VSIX. Equal sources give equal bytes, whatever the umask and the times of the files: with the environment
// variable SOURCE_DATE_EPOCH vsce sorts the files and dates them; their modes are set here.
import { chmod } from "node:fs/promises";
import { join } from "node:path";
import { PackageManager, createVSIX, listFiles } from "@vscode/vsce";

const root = join(import.meta.dirname, "..");
process.chdir(root);
process.umask(0o022);
for (const file of await listFiles({ cwd: root, packageManager: PackageManager.None })) {
  await chmod(join(root, file), 0o644);
}
await createVSIX({
  cwd: root,
  packagePath: join(root, "robbdd-workbench.vsix"),
  dependencies: false,
  allowMissingRepository: true,
});
