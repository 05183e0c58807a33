#!/usr/bin/env bash
# Drives Emacs, with the configurations of docs/editors.md and docs/debugging.md, through a model: with eglot, lsp-mode and
# dap-mode, or one of them.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
emacs=${ROBBDD_EMACS:-emacs}
export ROBBDD_LSP=${ROBBDD_LSP:-$root/.venv/bin/robbdd-lsp}
for client in ${*:-eglot lsp-mode dap-mode}; do
    page=docs/editors.md
    if [ "$client" = dap-mode ]; then
        page=docs/debugging.md
        if ! "$emacs" --batch -q --eval "(progn (package-activate-all) (require 'dap-mode))" >/dev/null 2>&1; then
            echo "not driven: dap-mode, which is not installed"
            continue
        fi
    fi
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    cp -r "$root/examples/pickplace" "$work/"
    echo "$client"
    (cd "$work/pickplace" && HOME="$work" XDG_CONFIG_HOME="$work" PATH="$(dirname "$ROBBDD_LSP"):$PATH" \
        timeout 900 "$emacs" --batch -q -l "$here/kit.el" \
        --eval "(robbdd-configure \"$root/$page\" '$client)" -l "$here/$client.el")
    rm -rf "$work"
done
