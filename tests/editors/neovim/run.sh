#!/usr/bin/env bash
# Drives Neovim, and Debian's old one, with the configurations of docs/editors.md, through a model.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
nvim=${ROBBDD_NVIM:-$root/.editors/neovim/bin/nvim}
old=$root/.editors/neovim-0.7
export ROBBDD_LSP=${ROBBDD_LSP:-$root/.venv/bin/robbdd-lsp}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$root/examples/pickplace" "$work/"
cd "$work/pickplace"

# Drive an editor with the nth configuration of the page: the one that users paste is under test.
drive() {
    local nth=$1 script=$2
    shift 2
    awk -v nth="$nth" '/^```/ { inside = /^```lua$/ && ++count == nth; next } inside' "$root/docs/editors.md" > "$work/init.lua"
    HOME="$work" XDG_CONFIG_HOME="$work" XDG_DATA_HOME="$work" XDG_STATE_HOME="$work" PATH="$(dirname "$ROBBDD_LSP"):$PATH" \
        timeout 900 "$@" --headless -u "$work/init.lua" -i NONE -n pickplace.bdd -c "luafile $here/$script"
}

drive 1 drive.lua "$nvim"
if [ -x "$old/usr/bin/nvim" ]; then
    drive 2 drive_0_7.lua env VIMRUNTIME="$old/usr/share/nvim/runtime" \
        LD_LIBRARY_PATH="$(echo "$old"/usr/lib/*-linux-gnu)" "$old/usr/bin/nvim"
else
    echo "not driven: Neovim 0.7, which only Debian 12 has"
fi
