#!/usr/bin/env bash
# Installs the package and what its tests need into an environment below the target folder, and runs pytest, mypy and the examples.
set -euo pipefail
cd "$(dirname "$0")"
environment="$(../install.sh)"
target="$(dirname "$environment")"
export MYPY_CACHE_DIR="$target/mypy" PYTHONDONTWRITEBYTECODE=1 WHISKMAP_WHEEL="$(echo "$target"/wheels/*.whl)"
"$environment/bin/pytest" -q -p no:cacheprovider -n auto --dist worksteal .
../examples/run.sh
