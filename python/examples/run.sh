#!/usr/bin/env bash
# Executes the notebooks and the example of derivatives in the environment of python/tests/run.sh, which must have run before.
# The executed notebooks (.ipynb) are written to the folder `notebooks` of the target folder.
set -euo pipefail
cd "$(dirname "$0")"
target="$(realpath -m "${CARGO_TARGET_DIR:-../../target}")"
environment="$target/python-environment"
if [ ! -x "$environment/bin/python" ]; then
    echo "error: $environment does not exist: run python/tests/run.sh first" >&2
    exit 2
fi
"$environment/bin/pip" install -q --disable-pip-version-check ipykernel jupytext nbconvert
mkdir -p "$target/notebooks"
export MPLBACKEND=module://matplotlib_inline.backend_inline PYTHONDONTWRITEBYTECODE=1
for notebook in *.md; do
    "$environment/bin/jupytext" --quiet --to ipynb --execute --run-path . \
        --output "$target/notebooks/${notebook%.md}.ipynb" "$notebook"
done
"$environment/bin/python" derivatives.py
