#!/usr/bin/env bash
# Builds the documentation site in the target folder, below `site/`. Broken links are errors.
set -euo pipefail
cd "$(dirname "$0")/../.."
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
environment="$(docs/site/environment.sh)"

# The pages in the folders of the repository, so that links between them and to pictures work as they do there.
export WHISKMAP_SITE_PAGES="$target/site-pages" WHISKMAP_SITE="$target/site"
rm -rf "$WHISKMAP_SITE_PAGES"
mkdir "$WHISKMAP_SITE_PAGES"
cp --parents ./*.md docs/*.md docs/site/api.md scenes/*.toml outputs/*.{json,png,svg,txt} crates/cli/explore.html "$WHISKMAP_SITE_PAGES"
# python/examples/run.sh leaves executed notebooks in the target folder. Other ones are shown without results.
if [ -d python/examples ]; then
    cp --parents python/examples/*.py "$WHISKMAP_SITE_PAGES"
    for page in python/examples/*.md; do
        notebook="$WHISKMAP_SITE_PAGES/${page%.md}.ipynb"
        cp "$target/notebooks/$(basename "$notebook")" "$notebook" 2>/dev/null ||
            "$environment/bin/jupytext" --quiet --to ipynb --output "$notebook" "$page"
    done
    # Here the notebooks are pages, and their folder has none.
    sed -i -E 's#(python/examples/[a-z0-9_]+)\.md\)#\1.ipynb)#g; s#\]\(python/examples/?\)#](docs/python.md)#g' \
        "$WHISKMAP_SITE_PAGES"/{,docs/}*.md
fi

WHISKMAP_SITE_RUST=https://docs.rs/whiskmap
[ ! -d "$target/doc/whiskmap" ] || WHISKMAP_SITE_RUST=rust/whiskmap/index.html
export WHISKMAP_SITE_RUST
# With `--quiet`, warnings would not count as errors.
unset PYTHONDONTWRITEBYTECODE
export NO_MKDOCS_2_WARNING=1 PYTHONPYCACHEPREFIX="$target/pycache"
if ! log="$("$environment/bin/mkdocs" build --strict --config-file docs/site/mkdocs.yml 2>&1)"; then
    echo "$log" >&2
    exit 1
fi
[ ! -d "$target/doc/whiskmap" ] || cp -r "$target/doc" "$WHISKMAP_SITE/rust"
"$environment/bin/python" docs/site/check_links.py "$WHISKMAP_SITE"
