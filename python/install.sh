#!/usr/bin/env bash
# Builds the package and installs it, with what its tests and examples need, into an environment below the target folder. Prints the
# folder of the environment.
set -euo pipefail
cd "$(dirname "$0")"
target="$(realpath -m "${CARGO_TARGET_DIR:-../target}")"
environment="$target/python-environment"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
"$environment/bin/pip" install -q --disable-pip-version-check \
    'maturin>=1.9.4,<2' 'dask[array]' ipykernel jupytext matplotlib mypy nbconvert numpy pandas pynwb pytest pytest-xdist scipy tqdm types-tqdm xarray zarr >&2
# Its dependencies are trackers, of which the type of tables in NWB files needs none.
"$environment/bin/pip" install -q --disable-pip-version-check --no-deps ndx-whisk >&2
rm -rf "$target/wheels"
# The profile of `tests/run.sh`, so that its crates are not built again.
"$environment/bin/maturin" build -q -m Cargo.toml --profile checked --locked --out "$target/wheels" >&2
"$environment/bin/pip" install -q --disable-pip-version-check --force-reinstall --no-deps "$target"/wheels/*.whl >&2
echo "$environment"
