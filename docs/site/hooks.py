"""Adds to the navigation what `mkdocs.yml` cannot name: notebooks, further pages of `docs/`, and the Rust library."""

import os
from pathlib import Path

from mkdocs.structure.nav import Link


def on_config(config):
    """Add notebooks after the pages about use, and to these the pages of `docs/` that have no place."""
    pages = Path(config.docs_dir)
    named = str(config.nav)
    found = sorted(str(page.relative_to(pages)) for page in pages.glob("docs/*.md"))
    config.nav[1]["Use"] += [page for page in found if page not in named]
    notebooks = sorted(str(page.relative_to(pages)) for page in pages.glob("python/examples/*.ipynb"))
    if notebooks:
        config.nav.insert(2, {"Notebooks": notebooks})
    return config


def on_nav(nav, config, files):
    """Add the link to the Rust library, copied below `rust/` or at docs.rs."""
    reference = next(item for item in nav.items if item.title == "Reference")
    link = Link("Rust library", os.environ["WHISKMAP_SITE_RUST"])
    link.parent = reference
    reference.children.append(link)
    return nav
