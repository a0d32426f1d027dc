#!/usr/bin/env bash
# Measures whiskmap's trajectories, detachment points and cells, and heyoka, AUTO-07p and scipy's solve_bvp on the same
# machine. Prints costs, errors and ratios, and writes outputs/peers.json. Installs the peers (AUTO only on Debian and
# Ubuntu), and names and omits a peer that cannot be installed.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$here/../.."
# Peers are measured one by one with a given number of threads; libraries must not start more.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi; }
has_auto() { command -v auto-07p && command -v gfortran && dpkg -L auto-07p; } >/dev/null 2>&1
has_python() { python3 -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))'; } >/dev/null 2>&1
install() {
    command -v apt-get >/dev/null &&
        as_root apt-get update -q &&
        as_root apt-get install -y -q --no-install-recommends "$@"
}
has_python || install python3 python3-venv || true
if ! has_python; then
    echo "Python 3.11 or later cannot be installed here: NO peer is measured"
    exit 0
fi
has_auto || install auto-07p gfortran || true

venv="$root/target/peers/venv"
python="$venv/bin/python"
[ -x "$python" ] || python3 -m venv "$venv"
while read -r requirement; do
    "$python" -m pip install --quiet --disable-pip-version-check "$requirement" </dev/null ||
        echo "pip cannot install $requirement"
done <"$here/requirements.txt"

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
can_import() { "$python" -I -c "import numpy, $1" 2>/dev/null; }
left_out() { echo "$1 cannot be installed here: it is NOT measured and left out below"; }
can_import heyoka || left_out heyoka
can_import scipy.integrate || left_out "scipy's solve_bvp"
if has_auto; then
    mapfile -t objects < <(dpkg -L auto-07p | grep '/lib/[^/]*\.o$')
    (cd "$scratch" &&
        gfortran -O3 -march=native -fopenmp -o whisker "$root/tests/peers/auto/whisker.f90" "${objects[@]}")
else
    left_out AUTO-07p
fi

# A shared machine is slow for seconds at a time, so programs are measured in turn, and the fastest round of each counts.
measure() {
    echo "measuring $1 ..."
    "$python" -B "$here/$1_peer.py" "${@:3}" >"$scratch/$1.$2.json"
}
for round in 1 2 3; do
    (cd "$root" && cargo bench --quiet --locked --bench peers -- \
        --json "$scratch/whiskmap.$round.json" --ensemble "$scratch/ensemble.csv")
    if can_import heyoka; then measure heyoka $round "$scratch/ensemble.csv"; fi
    if can_import scipy.integrate; then measure bvp $round; fi
    if has_auto; then measure auto $round "$scratch/whisker"; fi
done
"$python" -B "$here/compare.py" "$scratch" "$root/outputs/peers.json"
