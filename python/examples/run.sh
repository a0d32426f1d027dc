#!/usr/bin/env bash
# Installs the package into an environment below the target folder, and executes the notebooks and the example of derivatives there. The
# executed notebooks (.ipynb) are written to the folder `notebooks` of the target folder.
set -euo pipefail
cd "$(dirname "$0")"
environment="$(../install.sh)"
notebooks="$(dirname "$environment")/notebooks"
mkdir -p "$notebooks"
export MPLBACKEND=module://matplotlib_inline.backend_inline PYTHONDONTWRITEBYTECODE=1
for notebook in *.md; do
    "$environment/bin/jupytext" --quiet --to ipynb --execute --run-path . \
        --output "$notebooks/${notebook%.md}.ipynb" "$notebook"
done
"$environment/bin/python" derivatives.py
