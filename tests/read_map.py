"""Rebuilds every array of a map from the file alone. Usage: python3 read_map.py FILE

Needs `pip install OpenEXR numpy`.
"""
import json
import sys

import numpy as np
import OpenEXR


def read_map(path):
    """Axes, all attributes, and every channel as array[curvature, taper, distance, push angle]."""
    parts = OpenEXR.File(path, separate_channels=True).parts
    names = "axes scene title whiskmap_version engine adapter tolerances regime_names status_names counts panels"
    about = {name: json.loads(parts[0].header[name]) for name in names.split()}
    axes = {axis["name"]: np.array(axis["values"]) for axis in about["axes"]}
    columns, rows = about["panels"]
    shape = rows, len(axes["distance_mm"]), columns, len(axes["push_angle_deg"])
    channels = {
        name: channel.pixels.reshape(shape).transpose(0, 2, 1, 3)
        for part in parts
        for name, channel in part.channels.items()
    }
    return axes, about, channels


if __name__ == "__main__":
    axes, about, channels = read_map(sys.argv[1])
    print(about["title"])
    for name, values in axes.items():
        print(f"axis {name}: {values.size} values, {values[0]!r} to {values[-1]!r}")
    for name, array in channels.items():
        print(f"channel {name}: {array.dtype} {array.shape}")
    for code, name in about["regime_names"].items():
        cells = int((channels["regime"] == int(code)).sum())
        print(f"regime {name}: {cells} cells")
        assert cells == about["counts"]["regimes"][name], "the counts of the header differ from the cells"
