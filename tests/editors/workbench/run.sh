#!/usr/bin/env bash
# Run the workbench tests; setup.sh and `npm run package` in client-vscode come before. Pictures land in build/workbench/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
# One file after the other: two workbenches at a time only wait for each other.
exec node --test --test-concurrency=1 --test-reporter=spec ./*.test.mjs
