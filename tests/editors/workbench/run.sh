#!/usr/bin/env bash
# Run the workbench tests; setup.sh and `npm run package` in client-vscode come before. Pictures land in build/workbench/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
run=(node --test --test-concurrency=1 --test-reporter=spec ./*.test.mjs)
python=$PWD/../../../.venv/bin/python
# Language servers and agents are forks of a process that has imported everything (tests/fork_kit.py), unless a server is
# named. One file after the other: two workbenches at a time only wait for each other.
if [[ -z ${ROBBDD_LSP-} && -x $python ]]; then
    exec "$python" ../../fork_kit.py "${run[@]}"
fi
exec "${run[@]}"
