"""Datasets whose values are read from files, or computed, when they are used."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from threading import Lock
from typing import TYPE_CHECKING, Any, Protocol
from weakref import WeakValueDictionary

import numpy as np
import xarray as xr
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from whiskmap import _whiskmap
from whiskmap._datasets import attributes, scene_coords
from whiskmap._scene import Scene
from whiskmap._warnings import warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TYPES = {"regime": np.uint8, "status": np.uint8, "newton_steps": np.uint32}

# Cells of the whiskers that are read at once, of which only the selected ones stay in memory.
_CELLS_AT_ONCE = 1 << 22


class Source(Protocol):
    """A map of which whiskers are read. The first sweep axis varies fastest in the order of whiskers."""

    def channels(self) -> list[str]: ...
    def read(self, channel: str, whiskers: Sequence[int]) -> NDArray[Any]: ...


def dataset(source: Source, own: Mapping[str, xr.Variable], about: Mapping[str, Any], dropped: Iterable[str] = ()) -> xr.Dataset:
    """Return the dataset of a source with the coordinates `own` and the attributes `about`. A chunk is a whisker."""
    chunks = dict.fromkeys(own, 1) | {name: own[name].size for name in ("distance_mm", "push_angle_deg")}
    shape = tuple(axis.size for axis in own.values())
    variables = {}
    for name in source.channels():
        if name not in dropped:
            array = indexing.LazilyIndexedArray(_Channel(source, name, shape))
            meaning = json.loads(_whiskmap.channel_attributes(name) or "{}")
            variables[name] = xr.Variable(tuple(own), array, meaning, {"preferred_chunks": chunks})
    return xr.Dataset(variables, own, about)


class _Channel(BackendArray):
    """A channel of a map, of which whole whiskers are read."""

    def __init__(self, source: Source, name: str, shape: tuple[int, ...]) -> None:
        self.source, self.name, self.shape = source, name, shape
        self.dtype = np.dtype(_TYPES.get(name, np.float32))

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[Any, ...]) -> Any:
        whiskers: Any = np.zeros((), np.intp)
        stride = 1
        for size, index in zip(self.shape[:-2], key):
            # A whole number drops its axis.
            whiskers = np.add.outer(whiskers, stride * np.arange(size)[index])
            stride *= size
        at_once = max(1, _CELLS_AT_ONCE // (self.shape[-2] * self.shape[-1]))
        flat = np.ravel(whiskers)
        parts = [self._panels(flat[first : first + at_once], key) for first in range(0, max(1, flat.size), at_once)]
        panels = parts[0] if len(parts) == 1 else np.concatenate(parts)
        return panels.reshape(np.shape(whiskers) + panels.shape[1:])

    def _panels(self, whiskers: NDArray[np.intp], key: tuple[Any, ...]) -> Any:
        """Return the selected cells of some whiskers."""
        values = self.source.read(self.name, whiskers.tolist()).astype(self.dtype, copy=False)
        panels = values.reshape((len(whiskers), *self.shape[-2:]))
        return panels[:, key[-2]][..., key[-1]]


class ComputedMap:
    """The map of a scene, of which whiskers are computed when they are read, each with all its channels."""

    def __init__(
        self, scene: Scene, engine: str, tolerance_deg: float | None, channels: tuple[str, ...] | None, threads: int | None
    ) -> None:
        self._arguments = (scene, engine, tolerance_deg, channels, threads)
        self._map = _whiskmap.ComputedMap(scene._checked, engine, tolerance_deg, channels, threads)
        # A computation uses all threads, and the next one may need the whiskers that it computes.
        self._turn = Lock()

    def channels(self) -> list[str]:
        return self._map.channels()

    def read(self, channel: str, whiskers: Sequence[int]) -> NDArray[Any]:
        with self._turn:
            values, warnings = self._map.read(channel, whiskers)
        warn(warnings)
        return values

    def dataset(self) -> xr.Dataset:
        """Return the dataset, of which nothing is computed yet."""
        scene, _, tolerance_deg, *_ = self._arguments
        about = attributes(scene, self._map.engine())
        warn([self._map.warning()])
        return dataset(self, scene_coords(scene), about if tolerance_deg is None else about | {"tolerance_deg": tolerance_deg})

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return (_opened, self._arguments)


_OPEN: WeakValueDictionary[tuple[Any, ...], ComputedMap] = WeakValueDictionary()
_OPENING = Lock()


def _opened(*arguments: Any) -> ComputedMap:
    """Return the map that is open in this process: variables that are pickled one by one share what is computed."""
    with _OPENING:
        found = _OPEN.get(arguments)
        if found is None:
            found = _OPEN[arguments] = ComputedMap(*arguments)
        return found


class SolverBackend(BackendEntrypoint):
    """Backend of xarray that opens a `ComputedMap`."""

    open_dataset_parameters = ("filename_or_obj", "drop_variables")

    def open_dataset(self, filename_or_obj: Any, *, drop_variables: str | Iterable[str] | None = None) -> xr.Dataset:
        opened: xr.Dataset = filename_or_obj.dataset()
        return opened
