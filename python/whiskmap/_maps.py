"""Regime maps, and their cost."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Any, Literal

import xarray as xr

from whiskmap import _whiskmap
from whiskmap._datasets import attributes, scene_coords
from whiskmap._description import PARAMETERS, resembling
from whiskmap._lazy import ComputedMap, SolverBackend
from whiskmap._scene import Scene
from whiskmap._warnings import require, warn

Progress = Callable[[int, int], object]


def map(
    scene: Scene,
    *,
    engine: Literal["auto", "cpu", "spectral", "gpu"] = "auto",
    tolerance_deg: float | None = None,
    channels: Sequence[str] | None = None,
    progress: bool | Progress = False,
    threads: int | None = None,
    lazy: bool = False,
    chunks: Any = None,
) -> xr.Dataset:
    """Compute the regime map of a scene: every cell with its state.

    Parameters
    ----------
    scene : Scene
    engine : {"auto", "cpu", "spectral", "gpu"}
        "auto" selects the faster one of the two engines for the CPU. Both compute in float64; "gpu" computes in float32.
    tolerance_deg : float, optional
        Maximum error of push angles, in degrees; the finest steps if left out.
    channels : sequence of str, optional
        Names of the variables to compute, such as ``["regime", "force_un", "d_push_d_taper"]``; all but derivatives if left out.
        `d_push_d_taper` is the derivative of the push angle at the row's detachment.
    progress : bool or callable
        True shows a progress bar of tqdm, the extra `progress`. A callable gets the number of finished cells and of all cells.
    threads : int, optional
        Number of threads; one for each core, or `RAYON_NUM_THREADS`, if left out.
    lazy : bool
        True computes values when they are used. Indexing computes the selected whiskers, each with all channels, and keeps the newest
        256 MiB of them. Threads take turns. `progress` must be left out.
    chunks : optional
        With `lazy`, as in `xarray.open_dataset`: ``{}`` gives dask arrays with a chunk for each whisker.

    Returns
    -------
    xarray.Dataset
        Dimensions are the sweep axes, `distance_mm` and `push_angle_deg`, as in a Zarr store of the program. `regime` and
        `status` are CF flags. Other values are float32, NaN where the whisker is not in contact; units are in their attributes.
        A map of one whisker owns the memory in which it was computed.

    Raises
    ------
    MemoryError
        If the map, or with `lazy` the map of one whisker, takes more than 4 GiB.
    ValueError
        If the tolerance cannot be kept, or an argument is not allowed.
    RuntimeError
        If there is no GPU although one is required.
    ImportError
        If `progress` is True and tqdm is missing, or `chunks` is given and dask, the extra `lazy`, is missing.
    KeyboardInterrupt
        On Ctrl-C.
    """
    names = None if channels is None else _known(channels)
    if lazy:
        if progress is not False:
            raise ValueError(f"progress = {progress!r}: must be left out with lazy=True")
        return _lazy(scene, chunks, engine, tolerance_deg, None if names is None else tuple(names), threads)
    if chunks is not None:
        raise ValueError(f"chunks = {chunks!r}: must be left out without lazy=True")
    with _progress(progress) as report:
        arrays, used, _, warnings = _whiskmap.map(_checked(scene), engine, tolerance_deg, names, threads, report)
    warn(warnings)
    coords = scene_coords(scene)
    shape = tuple(own.size for own in coords.values())
    variables = {}
    for name, values in arrays:
        about = json.loads(_whiskmap.channel_attributes(name) or "{}")
        variables[name] = xr.Variable(tuple(coords), values.reshape(shape), about)
    about = attributes(scene, used)
    return xr.Dataset(variables, coords, about if tolerance_deg is None else about | {"tolerance_deg": tolerance_deg})


def _known(channels: Sequence[str]) -> list[str]:
    """Return the names of channels as a list; one that no channel has is refused."""
    names = [channels] if isinstance(channels, str) else list(channels)
    if isinstance(channels, str) or not all(isinstance(name, str) for name in names):
        raise TypeError(f"channels = {channels!r}: must be a list of names")
    if not names:
        raise ValueError("channels = []: must have at least one name")
    for name in names:
        if _whiskmap.channel_attributes(name) is None:
            plain = [*_whiskmap.channels(), "peak_strain"]
            hint = resembling(name, {own: own for own in (*plain, *(f"d_push_d_{own}" for own in PARAMETERS.values()))})
            raise ValueError(
                f"channels = {name!r}: must be a list of names out of {', '.join(plain)}, and derivatives such as d_push_d_taper{hint}"
            )
    return names


def _lazy(scene: Scene, chunks: Any, *options: Any) -> xr.Dataset:
    if chunks is not None:
        require("dask", "lazy")
    _checked(scene)
    source: Any = ComputedMap(scene, *options)
    return xr.open_dataset(source, engine=SolverBackend, chunks=chunks)


@dataclass(frozen=True)
class Plan:
    """Size of a map before it is computed.

    Attributes
    ----------
    whiskers, cells : int
        Numbers of whiskers of the sweep, and of cells of all their maps.
    memory_bytes : int or None
        Memory of `map`; None if it takes more than 4 GiB, so that only a store can hold the map.
    effects : dict of str to str
        Effects that are on, each with the key of the scene that decides it.
    """

    whiskers: int
    cells: int
    memory_bytes: int | None
    effects: dict[str, str]


def plan(scene: Scene) -> Plan:
    """Return the size of a scene's map. Nothing is computed.

    Raises
    ------
    MemoryError
        If the map of one whisker takes more than 4 GiB.
    """
    whiskers, cells, memory, effects = _whiskmap.plan(_checked(scene))
    on = {name: why for name, is_on, why in effects if is_on}
    return Plan(whiskers, cells, memory, on)


def _checked(scene: Scene) -> _whiskmap.CheckedScene:
    if not isinstance(scene, Scene):
        raise TypeError(f"scene = {scene!r}: must be a Scene")
    return scene._checked


def _progress(progress: bool | Progress) -> AbstractContextManager[Progress | None]:
    if callable(progress):
        return nullcontext(progress)
    if progress:
        require("tqdm", "progress")
        return _Bar()
    return nullcontext(None)


class _Bar(AbstractContextManager[Progress]):
    """A progress bar of tqdm."""

    def __init__(self) -> None:
        from tqdm.auto import tqdm

        self._bar = tqdm(unit="cell", unit_scale=True)

    def __enter__(self) -> Progress:
        def report(done: int, all_cells: int) -> None:
            self._bar.total = all_cells
            self._bar.update(done - self._bar.n)

        return report

    def __exit__(self, *_: Any) -> None:
        self._bar.close()
