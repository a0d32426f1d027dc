"""Stored maps as lazy datasets: EXR files and Zarr stores."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from typing import Any

import xarray as xr
from xarray.backends import BackendEntrypoint

from whiskmap import _whiskmap
from whiskmap._datasets import coords
from whiskmap._lazy import dataset
from whiskmap._warnings import require, warn


def open(path: str | os.PathLike[str], *, chunks: Any = None) -> xr.Dataset:
    """Open a map that the program has written: an EXR file or a Zarr store.

    Values are read when they are used, one whisker at a time.

    Parameters
    ----------
    path : path
    chunks : optional
        As in `xarray.open_dataset`: ``{}`` gives dask arrays with a chunk for each whisker.

    Returns
    -------
    xarray.Dataset
        As that of `map`. Cells of a store that are not computed yet have the `regime` 254 and NaN.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is no map, or damaged.
    ImportError
        If `chunks` is given and dask, the extra `lazy`, is missing.
    """
    if chunks is not None:
        require("dask", "lazy")
    return xr.open_dataset(os.fspath(path), engine=WhiskmapBackend, chunks=chunks)


class WhiskmapBackend(BackendEntrypoint):
    """Backend of xarray: ``xr.open_dataset("map.exr", engine="whiskmap")``."""

    description = "Maps of whiskmap: EXR files and Zarr stores"
    open_dataset_parameters = ("filename_or_obj", "drop_variables")

    def open_dataset(
        self, filename_or_obj: Any, *, drop_variables: str | Iterable[str] | None = None
    ) -> xr.Dataset:
        if not isinstance(filename_or_obj, (str, os.PathLike)):
            raise TypeError(f"{filename_or_obj!r}: must be the path of an EXR file or a Zarr store")
        stored = _whiskmap.StoredMap(os.fspath(filename_or_obj))
        warn([stored.warning()])
        dropped = {drop_variables} if isinstance(drop_variables, str) else set(drop_variables or ())
        about = {name: _attribute(text) for name, text in stored.attributes()}
        return dataset(stored, coords(stored.coordinates()), about, dropped)

    def guess_can_open(self, filename_or_obj: Any) -> bool:
        return isinstance(filename_or_obj, (str, os.PathLike)) and os.fspath(filename_or_obj).endswith(".exr")


def _attribute(text: str) -> Any:
    value = json.loads(text)
    return value if isinstance(value, (str, int, float)) else json.dumps(value)
