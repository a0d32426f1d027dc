"""Reads a map by the Python of the documentation, and holds it against the file's own counts.

Usage: python3 tests/read_map.py FILE. Needs `pip install OpenEXR numpy`.
"""
import json
import pathlib
import re
import sys

import numpy as np

SHOWN = '"outputs/cone.exr"'


def snippet():
    """The only block of Python in the documentation that reads a map."""
    root = pathlib.Path(__file__).resolve().parents[1]
    pages = [root / "README.md", *sorted(root.glob("docs/**/*.md"))]
    texts = [page.read_text(encoding="utf-8") for page in pages]
    blocks = [block for text in texts for block in re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)]
    (found,) = [block for block in blocks if SHOWN in block]
    return found


def check(axes, about, channels, parts):
    """Every channel has every cell, the counts are those of the cells, and quantities are where there is contact."""
    digits = json.loads(parts[0].header.get("digits", '""'))
    for name, number in (entry.split("=") for entry in digits.split(", ") if entry):
        bits = int(np.ceil(int(number) * np.log2(10)))
        dropped = channels[name].view(np.uint32) & (1 << 23 - bits) - 1
        assert not dropped[np.isfinite(channels[name])].any(), name
    names = "curvature_per_mm", "taper", "distance_mm", "push_angle_deg"
    shape = tuple(axes[name].size if name in axes else 1 for name in names)
    assert len(channels) == 14, sorted(channels)
    for name, array in channels.items():
        kind = np.uint32 if name in ("regime", "status", "newton_steps") else np.float32
        assert (array.shape, array.dtype) == (shape, kind), (name, array.shape, array.dtype)
    for code, name in about["regime_names"].items():
        cells = int((channels["regime"] == int(code)).sum())
        assert cells == about["counts"]["regimes"][name], (name, cells)
    codes = [int(code) for code, name in about["regime_names"].items() if name.startswith("contact")]
    contact = np.isin(channels["regime"], codes)
    assert contact.any() and (np.isfinite(channels["force_un"]) == contact).all()
    print(f"{sys.argv[1]}: {contact.size} cells of {len(channels)} channels, {contact.sum()} in contact")


if __name__ == "__main__":
    found = {}
    exec(snippet().replace(SHOWN, repr(sys.argv[1])), found)
    check(*(found[name] for name in ("axes", "about", "channels", "parts")))
