#!/usr/bin/env bash
# Pushes whiskers in PyElastica, a dynamic simulator of rods, until they detach:
#
#     benches/peers/pyelastica/run.sh [short]
#
# It writes detachments.csv, forces.csv and held.csv beside itself, and draws outputs/dynamics.svg from them. All pushes take less
# than an hour on one idle core; `short` leaves out the slow ones, and takes minutes. Needs Python 3.11 with venv.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$here/../../.."
venv="$root/target/peers/pyelastica"
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$here/requirements.txt"

push() { "$venv/bin/python" -B "$here/run.py" "$root/scenes/$@"; }
# Distance, and the push angle at detachment as from `whiskmap curve`.
cone=(cone.toml --distance 15.6604597633658 --detach 15.608)
robot=(robot.toml --distance 80 --detach 23.0141)
fast=(2000 1000 500 250 125 60 20)

rm -f "$here"/{detachments,forces,held}.csv
push "${cone[@]}" --damping 600 100 --rates "${fast[@]}"
push "${robot[@]}" --damping 600 100 --rates "${fast[@]}"
push "${cone[@]}" --damping 600 --hold 3 6 9 12 14 15
push "${robot[@]}" --damping 600 --hold 4 8 12 16 20 22
if [ "${1:-}" != short ]; then
    push "${cone[@]}" --damping 600 100 --rates 8 2 0.5
    push "${robot[@]}" --damping 600 100 --rates 8 2 0.5
    push "${cone[@]}" --damping 600 --rates 8 2 0.5 --elements 80
fi
cd "$root"
cargo run --release --locked --example dynamics
