#!/usr/bin/env bash
# Opens the page of `whiskmap explore` in Chromium and, if it is installed, in Firefox, uses it, and compares its numbers with those of the program:
#
#     tests/explore/run.sh [WHISKMAP [PART]]
#
# With PART, only tests whose names contain it run. `times` prints how long the page takes, which runs only by this name. Needs Chromium
# and Node.js; on Debian and Ubuntu it installs them if they are missing. Screenshots stay in target/explore.
set -euo pipefail
cd "$(dirname "$0")/../.."

target="${CARGO_TARGET_DIR:-target}"
whiskmap="$(realpath "${1:-$target/checked/whiskmap}")"
folder="$(realpath -m "$target/explore")"
mkdir -p "$folder"

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }
chromium="$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)"
missing=()
if [ -z "$chromium" ]; then missing+=(chromium fonts-dejavu-core); fi
if ! command -v npm >/dev/null; then missing+=(nodejs npm); fi
if [ ${#missing[@]} != 0 ]; then
    as_root apt-get update -q
    as_root apt-get install -y -q --no-install-recommends "${missing[@]}"
fi
chromium="${chromium:-$(command -v chromium)}"
if [ ! -d "$folder/node_modules/playwright-core" ]; then
    npm install --silent --no-audit --no-fund --prefix "$folder" playwright-core@1.56
fi
cp tests/explore/*.mjs "$folder"
# Node.js imports the page's modules too.
rm -rf "$folder/page"
cp -r crates/web/page "$folder/page"
echo '{"type": "module"}' >"$folder/page/package.json"
rm -f "$folder"/*.png
node "$folder/test.mjs" "$whiskmap" "$chromium" "$folder" "$PWD" "${2:-}"
firefox="$(command -v firefox || command -v firefox-esr || true)"
if [ -n "$firefox" ]; then
    node "$folder/firefox.mjs" "$whiskmap" "$firefox" "$folder" "$PWD"
else
    echo "ignored: the page in Firefox, because firefox is not installed"
fi
