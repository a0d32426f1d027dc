#!/usr/bin/env bash
# Builds the package and installs it, with what its tests and examples need, into an environment below the target folder. Prints the
# folder of the environment.
set -euo pipefail
cd "$(dirname "$0")"
environment="$(./environment.sh)"
target="$(dirname "$environment")"
rm -rf "$target/wheels"
# The profile of `tests/run.sh`, so that its crates are not built again.
"$environment/bin/maturin" build -q -m Cargo.toml --profile checked --locked --out "$target/wheels" >&2
"$environment/bin/pip" install -q --disable-pip-version-check --no-compile --force-reinstall --no-deps "$target"/wheels/*.whl >&2
echo "$environment"
