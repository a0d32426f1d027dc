"""Reads a store by the Python of the documentation, and holds it against the store's own counts.

Usage: python3 tests/read_store.py STORE [SLICE], the latter a store of a part of it. Needs `pip install xarray zarr`.
"""
import pathlib
import re
import sys
import warnings

import numpy as np
import xarray

SHOWN = '"outputs/morphology.zarr"'


def snippet():
    """The block of Python in the documentation that reads a store."""
    page = pathlib.Path(__file__).resolve().parents[1] / "docs" / "sweeps.md"
    blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
    (found,) = [block for block in blocks if SHOWN in block]
    return found


def check(store):
    """Axes, units and flags are there, and the counts are those of the cells."""
    names = "taper", "curvature_per_mm", "distance_mm", "push_angle_deg"
    assert store.regime.dims == names, store.regime.dims
    assert store.regime.dtype == np.uint8 and store.force_un.dtype == np.float32
    assert store.force_un.attrs["units"] == "uN" and store.distance_mm.attrs["units"] == "mm"
    meanings = store.regime.attrs["flag_meanings"].split()
    assert len(meanings) == len(store.regime.attrs["flag_values"])
    regime = store.regime.values
    counts = store.regime_cells.sum(dim=names[:2])
    for code, cells in zip(store.regime_code.values, counts.values):
        assert int((regime == code).sum()) == int(cells), (code, cells)
    for array in store.values():
        if "quantization" in array.attrs:
            assert store[array.attrs["quantization"]].attrs["algorithm"] == "bitround"
            dropped = array.values.view(np.uint32) & (1 << 23 - array.attrs["quantization_nsb"]) - 1
            assert not dropped[np.isfinite(array.values)].any(), array.name
    contact = np.isin(regime, [1, 4])
    assert contact.any() and (np.isfinite(store.force_un.values) == contact).all()
    print(f"{store.encoding['source']}: {regime.size} cells of {len(store)} variables, {contact.sum()} in contact")


if __name__ == "__main__":
    warnings.simplefilter("error")
    found = {}
    exec(snippet().replace(SHOWN, repr(sys.argv[1])), found)
    check(found["store"])
    for part in map(xarray.open_zarr, sys.argv[2:]):
        check(part)
        xarray.testing.assert_equal(part, found["store"].sel(part.indexes))
