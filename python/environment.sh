#!/usr/bin/env bash
# Installs what the package's tests and examples need into an environment below the target folder, without the package. Prints the folder of the
# environment.
set -euo pipefail
cd "$(dirname "$0")"
target="$(realpath -m "${CARGO_TARGET_DIR:-../target}")"
environment="$target/python-environment"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
# Only modules that are imported are compiled, which takes a third of the time.
"$environment/bin/pip" install -q --disable-pip-version-check --no-compile \
    'maturin>=1.9.4,<2' 'dask[array]' ipykernel jupytext matplotlib mypy nbconvert numpy pandas pynwb pytest pytest-xdist scipy tqdm types-tqdm xarray zarr >&2
# Its dependencies are trackers, of which the type of tables in NWB files needs none.
"$environment/bin/pip" install -q --disable-pip-version-check --no-compile --no-deps ndx-whisk >&2
echo "$environment"
