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
from whiskmap._values import by_index, csv_text, naming_rows, number, numbers, origin_of, own_names, side_of
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
    pulls : xarray.Dataset
        Points by their pull, the strongest first: index of the `point`, `residual_deg`, `weight` by the loss, and the `parameter` whose
        value would change most without the point, by so many `standard_errors`. Empty without standard errors.
    is_chord : bool
        True if the measured angles are chord angles, false for push angles.
    chi_square : float
        Sum of the losses of residuals over standard deviations: of their squares, unless another loss was given.
    degrees_of_freedom : int
    is_explained : bool
        True if the standard deviations of the points explain `chi_square`.
    not_a_fit : str or None
        Reason why the best values are not a fit.
    """

    scene: Scene
    estimates: xr.Dataset
    points: xr.Dataset
    pulls: xr.Dataset
    is_chord: bool
    chi_square: float
    degrees_of_freedom: int
    is_explained: bool
    not_a_fit: str | None


def fit(
    scene: Scene,
    points: str | os.PathLike[str] | Mapping[str, Any],
    free: Sequence[str],
    *,
    loss: Literal["squares", "soft-l1", "huber"] = "squares",
    columns: Mapping[str, str] | None = None,
) -> Fit:
    """Fit parameters of a scene to measured detachments, by least squares. The scene's values are the start.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker, or of a table of whiskers if the points name theirs.
    points : path, mapping or pandas.DataFrame
        A CSV file, or columns of equal length: `side` ("cb", "cf"), `distance_mm`, `push_angle_deg` or `push_chord_deg`, and
        if known `kind` ("slip-off", "pull-off") and `sd_deg`, the standard deviation of the angle. Missing values are NaN, None, NaT, NA or
        masked: a point without a number is left out, and one without a `kind` counts. A column `whisker` names the row of the scene's
        table that a point belongs to, as texts or whole numbers; all whiskers share the fitted values.
    free : sequence of str
        Names of the parameters to fit, such as ``["tip_radius_um", "parabola_per_mm"]``.
    loss : {"squares", "soft-l1", "huber"}
        Loss of residuals over their standard deviations, which are 1 degree without `sd_deg`. "soft-l1" and "huber" grow linearly beyond
        one, so that outliers pull less; standard errors then come from the scatter of the residuals.
    columns : mapping of str, optional
        Own names of columns by the expected ones, such as ``{"push_angle_deg": "angle"}``. An expected name may be shortened at an underscore.

    Raises
    ------
    ValueError
        If a parameter cannot be free, a point is beyond the whisker, points are too few, or a column is not known or missing.
    OSError
        If the file cannot be read.
    RuntimeError
        If the iteration does not converge.

    Warns
    -----
    SceneWarning
        If a parameter is not determined or at a limit, residuals are larger than their deviations, points are left out or have the other
        side's sign, or a parameter does not start at the scene's value. With another loss than squares, each outlier is named.
    """
    if isinstance(free, str):
        raise TypeError(f"free = {free!r}: must be a list of names")
    with naming_rows("points", points):
        text, origin = csv_text("points", points), origin_of("points", points)
        found = _whiskmap.fit(_checked(scene), text, origin, list(free), loss, own_names(columns))
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
        pulls=_pulls(found["pulls"]),
        is_chord=found["is_chord"],
        chi_square=found["chi_square"],
        degrees_of_freedom=found["degrees_of_freedom"],
        is_explained=found["is_explained"],
        not_a_fit=found["not_a_fit"],
    )


def _pulls(found: Sequence[tuple[int, float, float, str, float]]) -> xr.Dataset:
    names = ("point", "residual_deg", "weight", "parameter", "standard_errors")
    kinds = (np.int64, np.float64, np.float64, np.str_, np.float64)
    values = zip(*found) if found else ((),) * len(names)
    own: dict[str, Any] = {name: ("pull", np.array(list(all), dtype=kind)) for name, kind, all in zip(names, kinds, values)}
    return xr.Dataset(own)


@dataclass(frozen=True)
class Design:
    """Result of a design.

    Attributes
    ----------
    values : array of float
        Every value of the parameter with which the push reaches the target, growing; empty if there is none. With several parameters every
        solution, by `[solution, parameter]`.
    sides : array of str
        Side of the push of each solution: "cb" or "cf".
    range : tuple of float, or array of float
        Least and greatest value that limits and scene accept; with several parameters those of each, by `[parameter, end]`.
    ends : xarray.Dataset
        `kind` of the detachment and the value of the target's quantity, `reached`, over the range, by `value`, with the `side`. Empty with
        several parameters.
    nearest : xarray.Dataset or None
        With several parameters and without a solution: the `value` of each `parameter` that comes nearest, whether it is `at_limit`, and
        what is `reached` by `target`. None with a solution, and if no push ends as the targets need.
    """

    values: NDArray[np.float64]
    sides: NDArray[np.str_]
    range: tuple[float, float] | NDArray[np.float64]
    ends: xr.Dataset
    nearest: xr.Dataset | None


def design(
    scene: Scene,
    parameter: str | Sequence[str] | Mapping[str, tuple[float, float] | None],
    *,
    distance_mm: float | None = None,
    distance_to_length: float | None = None,
    side: Literal["both", "cb", "cf"] | None = None,
    slip_off_deg: float | None = None,
    pull_off_deg: float | None = None,
    max_force_un: float | None = None,
    max_moment_nnm: float | None = None,
    max_strain: float | None = None,
    keep: Literal["taper"] | None = None,
) -> Design:
    """Find every value of a parameter with which a push reaches a target, or those of several parameters with as many targets.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker. Its grid is not used.
    parameter : str, sequence of str, or mapping
        Name of the parameter to vary, such as "taper", or "distance_mm"; names of several; or limits by name, such as
        ``{"taper": (0.5, 1)}``, where None stands for those of the scene.
    distance_mm : float, optional
        Distance from the base to the contact at first touch, unless it varies.
    distance_to_length : float, optional
        The distance over the length of the whisker, such as 0.7, in place of `distance_mm`.
    side : {"both", "cb", "cf"}, optional
        Side of the whisker that the pole is on; needed for loads alone, else given by the sign of the angle. "both" searches both sides for
        a load and one parameter.
    slip_off_deg, pull_off_deg : float, optional
        Push angle at which the whisker slips off or is pulled off: positive CB, negative CF.
    max_force_un, max_moment_nnm, max_strain : float, optional
        Largest contact force with friction, moment at the base, or bending strain of the push until it ends.
    keep : "taper", optional
        Keep the taper where a radius varies, instead of the radius at the tip.

    Raises
    ------
    ValueError
        If the scene does not give a parameter, or a target is not allowed.

    Warns
    -----
    SceneWarning
        If several targets do not determine the parameters, so that solutions form a line; if every value in a range reaches the one target,
        which is then not in `values`; or if the largest strain of a solution exceeds the `yield_strain` of the scene.
    """
    targets = {
        "slip_off_deg": slip_off_deg,
        "pull_off_deg": pull_off_deg,
        "max_force_un": max_force_un,
        "max_moment_nnm": max_moment_nnm,
        "max_strain": max_strain,
    }
    given = {name: number(name, value) for name, value in targets.items() if value is not None}
    varied = _varied(parameter)
    if len(given) != len(varied):
        count = "one" if len(varied) == 1 else str(len(varied))
        raise TypeError(f"design() takes exactly {count} of {', '.join(targets)}; {len(given)} were given")
    if slip_off_deg is not None and pull_off_deg is not None:
        raise TypeError("slip_off_deg and pull_off_deg: a push ends in one way; give one of them")
    if keep not in (None, "taper"):
        raise ValueError(f"keep = {keep!r}: must be 'taper'")
    distance = _distance(distance_mm, distance_to_length, any(name == "distance_mm" for name, _ in varied))
    own = None if side is None else side_of(side)
    angles = [value for name, value in given.items() if not name.startswith("max_")]
    if len(varied) > 1:
        return _several(scene, varied, given, distance, own, angles, keep is not None)
    [(goal, value)] = given.items()
    sides: list[str | None] = [own]
    if own == "both":
        sides = [None] if angles else ["cf", "cb"]
    parts = [(of, *_whiskmap.design(_checked(scene), varied[0], goal, value, distance, of, keep is not None)) for of in sides]
    names = [of or ("cb" if value > 0 else "cf") for of, *_ in parts]
    values = np.concatenate([part[1] for part in parts])
    order = np.argsort(values, kind="stable")
    found_on = np.repeat(names, [len(part[1]) for part in parts])
    ends = [
        xr.Dataset(
            {"kind": ("value", kinds), "reached": ("value", np.array(reached, dtype=np.float64))},
            {"value": np.array(at), "side": ("value", [name] * len(at))},
        )
        for name, (_, _, _, at, kinds, reached, _) in zip(names, parts)
    ]
    warn([text for part in parts for text in part[-1]])
    [least, greatest] = parts[0][2]
    return Design(values[order], found_on[order], (least, greatest), xr.concat(ends, "value"), None)


_Varied = tuple[str, "tuple[float, float] | None"]


def _varied(parameter: str | Sequence[str] | Mapping[str, tuple[float, float] | None]) -> list[_Varied]:
    if isinstance(parameter, str):
        return [(parameter, None)]
    if not isinstance(parameter, Mapping):
        return [(name, None) for name in parameter]
    varied: list[_Varied] = []
    for name, limits in parameter.items():
        if limits is None:
            varied.append((name, None))
            continue
        ends = numbers(name, limits)
        if len(ends) != 2 or not ends[0] < ends[1]:
            raise ValueError(f"parameter[{name!r}] = {limits!r}: must be a least and a greatest value, or None")
        varied.append((name, (ends[0], ends[1])))
    return varied


def _distance(distance_mm: float | None, to_length: float | None, is_varied: bool) -> tuple[float, bool] | None:
    given = [own for own in (distance_mm, to_length) if own is not None]
    if len(given) != (0 if is_varied else 1):
        must = "must be left out, because distance_mm varies" if is_varied else "must be one of distance_mm and distance_to_length"
        raise TypeError(f"the distance {must}; {len(given)} were given")
    if distance_mm is not None:
        return number("distance_mm", distance_mm), False
    if to_length is None:
        return None
    part = number("distance_to_length", to_length)
    if not 0 < part < float("inf"):
        raise ValueError(f"distance_to_length = {to_length!r}: must be a positive number")
    return part, True


def _several(
    scene: Scene,
    varied: list[_Varied],
    given: Mapping[str, float],
    distance: tuple[float, bool] | None,
    side: str | None,
    angles: Sequence[float],
    keeps_taper: bool,
) -> Design:
    if side == "both" and not angles:
        raise ValueError("side = 'both': must be 'cb' or 'cf' with several parameters")
    if angles and side in (None, "both"):
        side = "cb" if angles[0] > 0 else "cf"
    found, ranges, is_undetermined, near, warnings = _whiskmap.designs(
        _checked(scene), varied, list(given.items()), distance, side, keeps_taper
    )
    warn(warnings)
    if is_undetermined:
        warn(["the targets do not determine these parameters: one can replace another along a line of values"])
    nearest = None
    if near is not None:
        values, reached, at_limit = near
        nearest = xr.Dataset(
            {
                "value": ("parameter", np.array(values)),
                "at_limit": ("parameter", np.array(at_limit)),
                "reached": ("target", np.array(reached)),
            },
            {"parameter": [name for name, _ in varied], "target": list(given)},
        )
    solutions = np.array(found, dtype=np.float64).reshape(-1, len(varied))
    return Design(solutions, np.array([side] * len(found), dtype=np.str_), np.array(ranges), xr.Dataset(), nearest)
