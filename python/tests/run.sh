#!/usr/bin/env bash
# Installs the package and what its tests need into an environment below the target folder, and runs pytest, mypy and the examples.
set -euo pipefail
cd "$(dirname "$0")"
environment="$(../install.sh)"
target="$(dirname "$environment")"
# Compiled modules are written to the target folder.
unset PYTHONDONTWRITEBYTECODE
export MYPY_CACHE_DIR="$target/mypy" PYTHONPYCACHEPREFIX="$target/pycache" WHISKMAP_WHEEL="$(echo "$target"/wheels/*.whl)"
"$environment/bin/pytest" -q -p no:cacheprovider -n auto --dist worksteal .
../examples/run.sh "$environment"
