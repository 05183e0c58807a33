#!/usr/bin/env bash
# Sees that there is an Emacs with eglot, lsp-mode and, where Debian has it, dap-mode; as root on Debian it installs them, elsewhere it names what is missing.
set -euo pipefail
emacs=${ROBBDD_EMACS:-emacs}
ready() { "$emacs" --batch -q --eval "(progn (require 'eglot) (require 'lsp-mode))" >/dev/null 2>&1; }
ready && exit 0
if [[ $EUID -ne 0 || -n ${ROBBDD_EMACS:-} ]] || ! command -v apt-get >/dev/null; then
    echo "please install Emacs with eglot (a part of it from version 29 on) and lsp-mode, and run this again"
    exit 1
fi
apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends emacs-nox elpa-eglot elpa-lsp-mode elpa-dap-mode >/dev/null
ready
