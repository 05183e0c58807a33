#!/usr/bin/env bash
# Run the workbench tests; setup.sh and `npm run package` in client-vscode come before. Pictures land in build/workbench/.
# A file that fails is run once more, in a new window: a loaded machine may lose a key. It fails if it fails twice; at the
# end, every file that needed its second run is named.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit
python=$PWD/../../../.venv/bin/python
# Language servers and agents are forks of a process that has imported everything (tests/fork_kit.py), unless a server is
# named. One file after the other: two workbenches at a time only wait for each other.
if [[ -z ${ROBBDD_LSP-} && -x $python ]]; then
    exec "$python" ../../fork_kit.py "$PWD/run.sh"
fi
again=() failed=()
for file in ./*.test.mjs; do
    if ! node --test --test-reporter=spec "$file"; then
        echo "workbench: $file failed, and is run once more"
        if node --test --test-reporter=spec "$file"; then again+=("$file"); else failed+=("$file"); fi
    fi
done
if ((${#again[@]})); then echo "workbench: UNSTABLE, passed in the second run: ${again[*]}"; fi
if ((${#failed[@]})); then
    echo "workbench: FAILED twice: ${failed[*]}"
    exit 1
fi
echo "workbench: all files passed"
