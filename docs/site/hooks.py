"""Adds to the navigation what `mkdocs.yml` cannot name: notebooks, further pages of `docs/`, and the Rust library.
Fails if the page of Python functions lacks a public name."""

import ast
import os
import re
from pathlib import Path

from mkdocs.exceptions import PluginError
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


def on_page_content(html, page, config, files):
    """Compare the headings of the page of Python functions with the names that the package exports."""
    if page.file.src_uri == "docs/site/api.md":
        root = Path(config.config_file_path).parents[2]
        package = ast.parse((root / "python/whiskmap/__init__.py").read_text())
        exports = {node.targets[0].id: node.value for node in package.body if isinstance(node, ast.Assign)}
        names = [*ast.literal_eval(exports["__all__"]), *ast.literal_eval(exports["_MODULES"])]
        missing = [name for name in names if not re.search(rf'id="whiskmap\.(_\w+\.)?{name}[".]', html)]
        if missing:
            raise PluginError(f"docs/site/api.md: no section describes {', '.join(missing)}")
    return html
