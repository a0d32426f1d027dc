"""Fits to measured detachments, and designs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import xarray as xr

from whiskmap import _whiskmap
from whiskmap._datasets import variables
from whiskmap._maps import _checked
from whiskmap._scene import Scene
from whiskmap._values import by_index, csv_text, naming_rows, number, origin_of, side_of
from whiskmap._warnings import warn

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Fit:
    """Result of a fit.

    Attributes
    ----------
    scene : Scene
        Scene with the fitted values.
    estimates : xarray.Dataset
        `value`, `standard_error` (NaN if the points do not determine the parameter, or it is at a limit), `at_limit` and
        `correlation`, by `parameter`; units are in the coordinate `units`.
    points : xarray.Dataset
        Measured points with the predictions of the fitted scene, by `point`; those without a residual have a `reason`: "missing" (a
        value) or "no-detachment".
    chi_square : float
        Sum of the squares of residuals over standard deviations.
    degrees_of_freedom : int
    is_explained : bool
        True if the standard deviations of the points explain `chi_square`.
    not_a_fit : str or None
        Reason why the best values are not a fit.
    """

    scene: Scene
    estimates: xr.Dataset
    points: xr.Dataset
    chi_square: float
    degrees_of_freedom: int
    is_explained: bool
    not_a_fit: str | None


def fit(scene: Scene, points: str | os.PathLike[str] | Mapping[str, Any], free: Sequence[str]) -> Fit:
    """Fit parameters of a scene to measured detachments, by least squares. The scene's values are the start.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker.
    points : path, mapping or pandas.DataFrame
        A CSV file, or columns of equal length: `side` ("cb", "cf"), `distance_mm`, `push_angle_deg` or `push_chord_deg`, and
        if known `kind` ("slip-off", "pull-off") and `sd_deg`, the standard deviation of the angle. A point with a number that is NaN or
        None is left out.
    free : sequence of str
        Names of the parameters to fit, such as ``["tip_radius_um", "parabola_per_mm"]``.

    Raises
    ------
    ValueError
        If a parameter cannot be free, a point is beyond the whisker, or points are too few.
    OSError
        If the file cannot be read.
    RuntimeError
        If the iteration does not converge.

    Warns
    -----
    SceneWarning
        If a parameter is not determined or at a limit, residuals are larger than their deviations, points are left out or have the other
        side's sign, or a parameter does not start at the scene's value.
    """
    if isinstance(free, str):
        raise TypeError(f"free = {free!r}: must be a list of names")
    with naming_rows("points", points):
        found = _whiskmap.fit(_checked(scene), csv_text("points", points), origin_of("points", points), list(free))
    warn(by_index("points", points, text) for text in found["warnings"])
    names, units, values, errors, at_limit = zip(*found["estimates"])
    correlation = np.array(found["correlation"], dtype=np.float64)
    estimates = xr.Dataset(
        {
            "value": ("parameter", np.array(values)),
            "standard_error": ("parameter", np.array(errors, dtype=np.float64)),
            "at_limit": ("parameter", np.array(at_limit)),
            "correlation": (("parameter", "other"), correlation),
        },
        {"parameter": list(names), "other": list(names), "units": ("parameter", list(units))},
    )
    return Fit(
        scene=Scene._of(found["scene"]),
        estimates=estimates,
        points=xr.Dataset(variables(found["points"], ("point",), (-1,), without=("line",))),
        chi_square=found["chi_square"],
        degrees_of_freedom=found["degrees_of_freedom"],
        is_explained=found["is_explained"],
        not_a_fit=found["not_a_fit"],
    )


@dataclass(frozen=True)
class Design:
    """Result of a design.

    Attributes
    ----------
    values : array of float
        Every value of the parameter with which the push reaches the target, growing; empty if there is none.
    sides : array of str
        Side of the push of each value: "cb" or "cf".
    range : tuple of float
        Least and greatest value that the scene accepts.
    ends : xarray.Dataset
        `kind` of the detachment and the value of the target's quantity, `reached`, over the range, by `value`, with the `side`.
    """

    values: NDArray[np.float64]
    sides: NDArray[np.str_]
    range: tuple[float, float]
    ends: xr.Dataset


def design(
    scene: Scene,
    parameter: str,
    *,
    distance_mm: float,
    side: Literal["both", "cb", "cf"] | None = None,
    slip_off_deg: float | None = None,
    pull_off_deg: float | None = None,
    max_force_un: float | None = None,
    max_moment_nnm: float | None = None,
    max_strain: float | None = None,
) -> Design:
    """Find every value of a parameter with which a push reaches a target. Exactly one target is given.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker. Its grid is not used.
    parameter : str
        Name of the parameter to vary, such as "taper".
    distance_mm : float
        Distance from the base to the contact at first touch.
    side : {"both", "cb", "cf"}, optional
        Side of the whisker that the pole is on; needed for a load, else given by the sign of the angle. "both" searches both sides for a
        load.
    slip_off_deg, pull_off_deg : float, optional
        Push angle at which the whisker slips off or is pulled off: positive CB, negative CF.
    max_force_un, max_moment_nnm, max_strain : float, optional
        Largest contact force, moment at the base, or bending strain of the push until it ends.

    Raises
    ------
    ValueError
        If the scene does not give the parameter, or a target is not allowed.
    """
    targets = {
        "slip_off_deg": slip_off_deg,
        "pull_off_deg": pull_off_deg,
        "max_force_un": max_force_un,
        "max_moment_nnm": max_moment_nnm,
        "max_strain": max_strain,
    }
    given = {name: number(name, value) for name, value in targets.items() if value is not None}
    if len(given) != 1:
        raise TypeError(f"design() takes exactly one of {', '.join(targets)}; {len(given)} were given")
    [(goal, value)] = given.items()
    distance = number("distance_mm", distance_mm)
    is_load = goal.startswith("max_")
    own = None if side is None else side_of(side)
    sides: list[str | None] = [own]
    if own == "both":
        sides = ["cf", "cb"] if is_load else [None]
    parts = [(of, *_whiskmap.design(_checked(scene), parameter, goal, value, distance, of)) for of in sides]
    names = [of or ("cb" if value > 0 else "cf") for of, *_ in parts]
    values = np.concatenate([part[1] for part in parts])
    order = np.argsort(values, kind="stable")
    found_on = np.repeat(names, [len(part[1]) for part in parts])
    ends = [
        xr.Dataset(
            {"kind": ("value", kinds), "reached": ("value", np.array(reached, dtype=np.float64))},
            {"value": np.array(at), "side": ("value", [name] * len(at))},
        )
        for name, (_, _, _, at, kinds, reached) in zip(names, parts)
    ]
    [least, greatest] = parts[0][2]
    return Design(values[order], found_on[order], (least, greatest), xr.concat(ends, "value"))
