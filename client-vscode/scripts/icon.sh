#!/bin/sh
# Draws images/icon.png from images/icon.svg (a VSIX icon must be a bitmap). Needs Chromium.
set -eu
cd "$(dirname "$0")/../images"
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
"${CHROMIUM:-chromium}" --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$profile" \
    --default-background-color=00000000 --window-size=256,256 --screenshot="$PWD/icon.png" "file://$PWD/icon.svg" 2>/dev/null
