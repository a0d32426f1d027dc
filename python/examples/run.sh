#!/usr/bin/env bash
# Executes the notebooks and the example of derivatives in an environment below the target folder: the one that the argument names, which has
# the package, or one into which it installs the package. The executed notebooks (.ipynb) are written to the folder `notebooks` of the target folder.
set -euo pipefail
cd "$(dirname "$0")"
environment="${1:-$(../install.sh)}"
target="$(dirname "$environment")"
notebooks="$target/notebooks"
mkdir -p "$notebooks"
unset PYTHONDONTWRITEBYTECODE
export MPLBACKEND=module://matplotlib_inline.backend_inline PYTHONPYCACHEPREFIX="$target/pycache"
for notebook in *.md; do
    "$environment/bin/jupytext" --quiet --to ipynb --execute --run-path . \
        --output "$notebooks/${notebook%.md}.ipynb" "$notebook"
done
"$environment/bin/python" derivatives.py
