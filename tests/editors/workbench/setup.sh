#!/usr/bin/env bash
# Install what the workbench tests need into a cache folder: code-server (VS Code in a browser) and playwright-core.
# As root on Debian it also installs the packages that are missing; elsewhere it names them.
# ROBBDD_WORKBENCH_CACHE names the folder; without it `.workbench/` at the top of the checkout is used.
# Nothing is done when the versions below are there already.
set -euo pipefail

CODE_SERVER=4.100.3 # the newest that runs on Node 20
PLAYWRIGHT=1.65.1

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=${ROBBDD_WORKBENCH_CACHE:-$(cd "$here/../../.." && pwd)/.workbench}

say() { printf 'workbench: %s\n' "$*"; }

# Each tool with the Debian package that carries it, where the two differ in name.
declare -A package=([rg]=ripgrep)
missing=()
for tool in chromium rg gcc g++ make python3; do
    command -v "$tool" >/dev/null || missing+=("${package[$tool]:-$tool}")
done
if ((${#missing[@]})); then
    if [[ $EUID -ne 0 ]] || ! command -v apt-get >/dev/null; then
        say "please install ${missing[*]} and run this again"
        exit 1
    fi
    say "installing ${missing[*]}"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

wanted="code-server $CODE_SERVER, playwright-core $PLAYWRIGHT, node $(node -p process.versions.modules)"
if [[ -f $cache/installed && $(<"$cache/installed") == "$wanted" ]]; then
    say "already in $cache"
    exit 0
fi

export npm_config_audit=false npm_config_fund=false npm_config_update_notifier=false npm_config_loglevel=error
export npm_config_yes=true # node-pty's build asks for node-gyp
export PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1

mkdir -p "$cache"
rm -rf "$cache"/{node_modules,package.json,package-lock.json,installed}
echo '*' >"$cache/.gitignore" # the folder lies in the checkout by default
cd "$cache"
echo '{ "name": "robbdd-workbench-cache", "private": true }' >package.json

say "code-server $CODE_SERVER and playwright-core $PLAYWRIGHT"
# Without scripts: code-server's own postinstall builds kerberos, which needs headers that nothing here uses.
npm install --ignore-scripts --save-exact "code-server@$CODE_SERVER" "playwright-core@$PLAYWRIGHT"

vscode=$cache/node_modules/code-server/lib/vscode
say "the editor's own dependencies"
for folder in "$vscode" "$vscode/extensions"; do
    (cd "$folder" && npm install --ignore-scripts --omit=dev)
done

say "native modules"
npm rebuild argon2
(cd "$vscode" && npm rebuild @vscode/spdlog native-watchdog node-pty)

# What the skipped postinstall would have arranged.
ln -sfn node_modules "$vscode/node_modules.asar"
ln -sfn code-linux.sh "$vscode/bin/remote-cli/code-server"
ln -sfn browser-linux.sh "$vscode/bin/helpers/browser.sh"
mkdir -p "$vscode/node_modules/@vscode/ripgrep/bin"
ln -sfn "$(command -v rg)" "$vscode/node_modules/@vscode/ripgrep/bin/rg"

echo "$wanted" >installed
say "ready in $cache ($(du -sh "$cache" | cut -f1))"
