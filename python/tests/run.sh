#!/usr/bin/env bash
# Installs the package and what its tests need into an environment below the target folder, and runs pytest, mypy and the examples.
set -euo pipefail
cd "$(dirname "$0")"
target="$(realpath -m "${CARGO_TARGET_DIR:-../../target}")"
environment="$target/python-environment"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
"$environment/bin/pip" install -q --disable-pip-version-check \
    'maturin>=1.9.4,<2' 'dask[array]' matplotlib mypy numpy pandas pytest scipy tqdm types-tqdm xarray zarr
rm -rf "$target/wheels"
# The profile of the other tests, so that their crates are not built again.
"$environment/bin/maturin" build -q -m ../Cargo.toml --profile checked --locked --out "$target/wheels"
"$environment/bin/pip" install -q --disable-pip-version-check --force-reinstall --no-deps "$target"/wheels/*.whl
export MYPY_CACHE_DIR="$target/mypy" PYTHONDONTWRITEBYTECODE=1
"$environment/bin/pytest" -q -p no:cacheprovider .
CARGO_TARGET_DIR="$target" ../examples/run.sh
