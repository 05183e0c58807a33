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
cp -r "$root/examples/pickplace" "$root/examples/ownrobot" "$work/"
cd "$work/pickplace"

# Drive an editor with configurations of the page, from the first to the last: those that users paste are under test.
drive() {
    local first=$1 last=$2 script=$3
    shift 3
    awk -v first="$first" -v last="$last" '/^```/ { inside = /^```lua$/ && ++count >= first && count <= last; next } inside' "$root/docs/editors.md" > "$work/init.lua"
    HOME="$work" XDG_CONFIG_HOME="$work" XDG_DATA_HOME="$work" XDG_STATE_HOME="$work" PATH="$(dirname "$ROBBDD_LSP"):$PATH" \
        timeout 900 "$@" --headless -u "$work/init.lua" -i NONE -n pickplace.bdd -c "luafile $here/$script"
}

drive 1 2 drive.lua "$nvim"
if [ -x "$old/usr/bin/nvim" ]; then
    drive 3 3 drive_0_7.lua env VIMRUNTIME="$old/usr/share/nvim/runtime" \
        LD_LIBRARY_PATH="$(echo "$old"/usr/lib/*-linux-gnu)" "$old/usr/bin/nvim"
else
    echo "not driven: Neovim 0.7, which only Debian 12 has"
fi
