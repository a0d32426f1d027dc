"""Stored maps as lazy datasets: EXR files and Zarr stores."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from whiskmap import _whiskmap
from whiskmap._datasets import coords
from whiskmap._warnings import require, warn

_TYPES = {"regime": np.uint8, "status": np.uint8, "newton_steps": np.uint32}


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
        own = coords(stored.coordinates())
        shape = tuple(axis.size for axis in own.values())
        # A chunk is a whisker.
        chunks = dict.fromkeys(own, 1) | {name: own[name].size for name in ("distance_mm", "push_angle_deg")}
        variables = {}
        for name in stored.channels():
            if name not in dropped:
                array = indexing.LazilyIndexedArray(_Channel(stored, name, shape))
                about = json.loads(_whiskmap.channel_attributes(name) or "{}")
                variables[name] = xr.Variable(tuple(own), array, about, {"preferred_chunks": chunks})
        return xr.Dataset(variables, own, {name: _attribute(text) for name, text in stored.attributes()})

    def guess_can_open(self, filename_or_obj: Any) -> bool:
        return isinstance(filename_or_obj, (str, os.PathLike)) and os.fspath(filename_or_obj).endswith(".exr")


class _Channel(BackendArray):
    """A channel of a stored map, of which whole whiskers are read."""

    def __init__(self, stored: _whiskmap.StoredMap, name: str, shape: tuple[int, ...]) -> None:
        self.stored, self.name, self.shape = stored, name, shape
        self.dtype = np.dtype(_TYPES.get(name, np.float32))

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[Any, ...]) -> Any:
        sweep, panel = self.shape[:-2], self.shape[-2:]
        whiskers = np.arange(int(np.prod(sweep))).reshape(sweep)
        # As `numpy.ix_`, but a whole number drops its axis.
        for axis in range(len(sweep))[::-1]:
            whiskers = whiskers[(slice(None),) * axis + (key[axis],)]
        rows = self.stored.read(self.name, np.ravel(whiskers).tolist()).reshape(np.shape(whiskers) + panel)
        rows = rows[..., key[-2], :]
        return rows[..., key[-1]]


def _attribute(text: str) -> Any:
    value = json.loads(text)
    return value if isinstance(value, (str, int, float)) else json.dumps(value)
