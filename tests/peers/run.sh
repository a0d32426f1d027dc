#!/usr/bin/env bash
# Compares whiskmap with AUTO-07p on the paper's boundary-value problem. The program is the first argument; without it, it is
# built. AUTO is installed on Debian and Ubuntu. Without AUTO, the script prints a message and exits with 0, or with 1 if
# WHISKMAP_REQUIRE_PEERS=1.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"

installed() { command -v auto-07p && command -v gfortran && command -v python3; } >/dev/null
as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi; }
install() {
    command -v apt-get >/dev/null &&
        as_root apt-get update -q &&
        as_root apt-get install -y -q --no-install-recommends auto-07p gfortran python3
}
if ! installed && ! { install && installed; }; then
    echo "AUTO-07p cannot be installed here: peer check NOT run"
    exit "${WHISKMAP_REQUIRE_PEERS:-0}"
fi

if [ $# -gt 0 ]; then
    whiskmap="$(realpath "$1")"
else
    cargo build --release --locked --manifest-path "$here/../../Cargo.toml"
    whiskmap="$here/../../target/release/whiskmap"
fi

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
mapfile -t objects < <(dpkg -L auto-07p | grep '/lib/[^/]*\.o$')
(cd "$scratch" && gfortran -O2 -fopenmp -o whisker "$here/auto/whisker.f90" "${objects[@]}")
python3 -B "$here/compare.py" "$whiskmap" "$scratch/whisker"
