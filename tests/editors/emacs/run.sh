#!/usr/bin/env bash
# Drives Emacs, with the configurations of docs/editors.md, through a model: with eglot and lsp-mode, or one of them.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
emacs=${ROBBDD_EMACS:-emacs}
export ROBBDD_LSP=${ROBBDD_LSP:-$root/.venv/bin/robbdd-lsp}
for client in ${*:-eglot lsp-mode}; do
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    cp -r "$root/examples/pickplace" "$work/"
    echo "$client"
    (cd "$work/pickplace" && HOME="$work" XDG_CONFIG_HOME="$work" PATH="$(dirname "$ROBBDD_LSP"):$PATH" \
        timeout 900 "$emacs" --batch -q -l "$here/kit.el" \
        --eval "(robbdd-configure \"$root/docs/editors.md\" '$client)" -l "$here/$client.el")
    rm -rf "$work"
done
