"""Fails if a page of the site refers to a file or an anchor that is not there, or loads a file from another server."""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The anchors of a page, and what it refers to: (tag, address)."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.references = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("id", "name"):
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.references.append((tag, value))


site = Path(sys.argv[1]).resolve()
# rustdoc checks its own links. The explorer's page makes its addresses by script.
skipped = [site / "rust", site / "outputs", site / "crates"]
paths = [path for path in site.rglob("*.html") if not any(path.is_relative_to(folder) for folder in skipped)]
pages = {path: Page(path.read_text()) for path in paths}
faults = []
for path, page in pages.items():
    for tag, address in page.references:
        url = urlsplit(address)
        if url.netloc and tag != "a" or url.scheme == "file":
            faults.append(f"{path}: {tag} loads {address}")
        # mkdocs makes the addresses of its page for missing pages absolute.
        if url.scheme or url.netloc or path.name == "404.html":
            continue
        target = (path.parent / unquote(url.path)).resolve() if url.path else path
        target = target / "index.html" if target.is_dir() else target
        fragment = unquote(url.fragment)
        if not target.exists():
            faults.append(f"{path}: no file {address}")
        elif fragment and target in pages and fragment not in pages[target].anchors:
            faults.append(f"{path}: no anchor {address}")
if not pages:
    faults.append(f"{site}: no pages")
sys.exit("\n".join(faults) or None)
