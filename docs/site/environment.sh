#!/usr/bin/env bash
# Installs what the documentation site is built with into an environment below the target folder. Prints the folder of the environment.
set -euo pipefail
cd "$(dirname "$0")/../.."
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
environment="$target/site-environment"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
"$environment/bin/pip" install -q --disable-pip-version-check --no-compile \
    jupytext 'mkdocs>=1.6,<2' mkdocs-jupyter 'mkdocs-material>=9,<10' 'mkdocstrings[python]>=1,<2' ruff >&2
echo "$environment"
