#!/usr/bin/env bash
# Drives Neovim, with the configuration of docs/editors.md, through a model.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
nvim=${ROBBDD_NVIM:-$root/.editors/neovim/bin/nvim}
export ROBBDD_LSP=${ROBBDD_LSP:-$root/.venv/bin/robbdd-lsp}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$root/examples/pickplace" "$work/"
# The configuration that users are told to paste is the one under test.
sed -n '/^```lua$/,/^```$/p' "$root/docs/editors.md" | sed '1d;$d' > "$work/init.lua"
cd "$work/pickplace"
HOME="$work" XDG_CONFIG_HOME="$work" XDG_DATA_HOME="$work" XDG_STATE_HOME="$work" PATH="$(dirname "$ROBBDD_LSP"):$PATH" \
    timeout 900 "$nvim" --headless -u "$work/init.lua" -i NONE -n pickplace.bdd -c "luafile $here/drive.lua"
