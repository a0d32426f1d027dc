"""Contacts from moment and force at the base."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import xarray as xr

from whiskmap import _whiskmap
from whiskmap._datasets import attributes, rest_coords, variables
from whiskmap._maps import _checked
from whiskmap._scene import Scene
from whiskmap._values import csv_text, naming_rows, number, origin_of, own_names
from whiskmap._warnings import warn


def locate(
    scene: Scene,
    readings: str | os.PathLike[str] | Mapping[str, Any],
    *,
    moment_sd_nnm: float | None = None,
    force_sd_un: float | None = None,
    columns: Mapping[str, str] | None = None,
) -> xr.Dataset:
    """Find the contacts that belong to moment and force at the base, as a sensor measures them.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker without friction. Its grid is not used.
    readings : path, mapping or pandas.DataFrame
        A CSV file, or columns of equal length: at least two of `base_moment_nnm`, `base_force_x_un` and `base_force_y_un`, in the frame of
        the base, and optionally `angle_deg`, the angle of the base in the laboratory. Columns of one reading may be numbers. A number that
        was not measured is NaN, None, NA or masked.
    moment_sd_nnm, force_sd_un : float, optional
        Standard deviations of the sensor's moment, and of each component of its force; both or none.
    columns : mapping of str, optional
        Own names of columns by the expected ones, such as ``{"base_moment_nnm": "Mz"}``. An expected name may be shortened at an underscore.

    Returns
    -------
    xarray.Dataset
        All stable states with the numbers of each reading, by `number`: `reading` (from 1), `states` (their count for the reading),
        contact, distance, push angle, force, `condition` and standard deviations. A reading without a state has NaN and a `reason`
        ("incomplete", "no-load", "undetermined", "no-state").

    Raises
    ------
    ValueError
        If columns are missing, a value is out of its range, a standard deviation is not positive or is alone, or the scene has friction.
    OSError
        If the file cannot be read.

    Warns
    -----
    SceneWarning
        If readings have no state.
    """
    checked, deviations = _checked(scene), _deviations(moment_sd_nnm, force_sd_un)
    with naming_rows("readings", readings):
        text, origin = csv_text("readings", readings), origin_of("readings", readings)
        found, warning = _whiskmap.locate(checked, text, origin, own_names(columns), deviations)
    warn([warning])
    return xr.Dataset(variables(found, ("number",), (-1,)), rest_coords(scene), attributes(scene))


def _deviations(moment_sd_nnm: float | None, force_sd_un: float | None) -> tuple[float, float] | None:
    if moment_sd_nnm is None and force_sd_un is None:
        return None
    if moment_sd_nnm is None or force_sd_un is None:
        raise ValueError("moment_sd_nnm and force_sd_un: must both be given, or none")
    deviations = number("moment_sd_nnm", moment_sd_nnm), number("force_sd_un", force_sd_un)
    for name, value in zip(("moment_sd_nnm", "force_sd_un"), deviations):
        if not 0 < value < float("inf"):
            raise ValueError(f"{name} = {value}: must be more than 0 and finite")
    return deviations
