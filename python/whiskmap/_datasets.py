"""Columns of the library as variables of xarray datasets."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from whiskmap._whiskmap import arithmetic, coordinates, version

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from whiskmap._scene import Scene
    from whiskmap._whiskmap import _Column, _Coordinate


def coords(own: Iterable[_Coordinate]) -> dict[str, xr.Variable]:
    """Return coordinates by name, with their CF attributes."""
    return {name: xr.Variable(name, values, json.loads(attributes)) for name, attributes, values in own}


def scene_coords(scene: Scene) -> dict[str, xr.Variable]:
    """Return the coordinates of a scene's maps, in the order of their dimensions."""
    return coords(coordinates(scene._checked))


def rest_coords(scene: Scene) -> dict[str, xr.Variable]:
    """Return degree and rms distance of a traced shape as scalar coordinates, which are columns of data frames; nothing without one."""
    fit = scene.rest_fit
    if fit is None:
        return {}
    meanings = {
        "rest_degree": (fit.degree, {"long_name": "degree of the fitted curvature"}),
        "rest_rms_mm": (fit.rms_mm, {"units": "mm", "long_name": "rms distance of the traced points"}),
    }
    return {name: xr.Variable((), value, about) for name, (value, about) in meanings.items()}


def attributes(scene: Scene, engine: str | None = None) -> dict[str, Any]:
    """Return the global attributes of a dataset, which are enough to compute it again."""
    own = {"Conventions": "CF-1.11", "title": scene.title, "scene": scene.to_toml()}
    own |= {"whiskmap_version": version(), "arithmetic": arithmetic()}
    return own | ({} if engine is None else {"engine": engine})


def variables(
    columns: Iterable[_Column], dims: Sequence[str], shape: Sequence[int], without: Sequence[str] = ()
) -> dict[str, xr.Variable]:
    """Return columns as variables of this shape, with their CF attributes. Sweep axes of the rows vary fastest first."""
    found = {}
    for name, values, units, meaning in columns:
        if name in without:
            continue
        array = np.array(values, dtype=np.str_) if isinstance(values, list) else values
        about = {"long_name": _long_name(name), "comment": meaning} | ({} if units is None else {"units": units})
        found[name] = xr.Variable(dims, in_order(array, shape), about)
    return found


def _long_name(name: str) -> str:
    """Return the words of a column's name without its unit: short enough for an axis of a plot. The comment has the meaning."""
    words = name.split("_")
    return " ".join(words[:-1] if len(words) > 1 and words[-1] in _UNITS else words)


_UNITS = ("mm", "um", "deg", "un", "nnm", "nj", "s")


def in_order(rows: NDArray[Any], shape: Sequence[int]) -> NDArray[Any]:
    """Return rows in an array of this shape. Whiskers come with the first sweep axis varying fastest; two axes follow."""
    sweep, rest = tuple(shape[:-2]), tuple(shape[-2:])
    array = rows.reshape(sweep[::-1] + rest)
    count = len(sweep)
    return array.transpose(*range(count)[::-1], *range(count, len(shape)))


def row(columns: Iterable[_Column], without: Sequence[str] = ()) -> Mapping[str, Any]:
    """Return the values of a table of one row by name, without those that do not exist."""
    found = {name: values[0] for name, values, *_ in columns if name not in without}
    plain = {name: value if isinstance(value, str) else value.item() for name, value in found.items()}
    return {name: value for name, value in plain.items() if value != "" and value == value}
