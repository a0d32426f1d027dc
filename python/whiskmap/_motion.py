"""Courses of whiskers in time: whisking against a pole, and sweeps over a rough surface; forces from the change of curvature."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import xarray as xr

from whiskmap import _whiskmap
from whiskmap._datasets import attributes, rest_coords, variables
from whiskmap._maps import _checked
from whiskmap._scene import Scene
from whiskmap._values import (
    check_labels,
    csv_text,
    naming_rows,
    number,
    numbers,
    origin_of,
    own_names,
    real_array,
    real_array_or_nan,
)
from whiskmap._warnings import warn

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from whiskmap._whiskmap import _Column


@dataclass(frozen=True)
class Whisk:
    """Course of a whisker in front of one pole.

    Attributes
    ----------
    samples : xarray.Dataset
        State at each of the times, by `time_s`: `angle_deg`, `regime` ("free", "contact", "undecided"), `side`, loads and energy. Loads
        of a free whisker are 0. The position of the contact, `contact_x_mm` and `contact_y_mm`, is in axes that do not turn with the base:
        the first is along its tangent at first touch on CB. NaN where there is no contact, or where a sample is undecided for the `reason`. In gaps the reason is
        "missing", or "bridged" if the course continues across the gap; after a gap that is not bridged it is "after-gap".
    events : xarray.Dataset
        Touches, releases, slip-offs, pull-offs and snaps between samples, by `number`: `time_s`, `event`, `angle_deg` and the state.
    lost_nj : float
        Energy that the detachments lose, in nJ; NaN if one is not known, as after a gap that is not bridged.
    dissipated_nj : float
        Energy that friction dissipates, in nJ; NaN if a part of the course is undecided.
    cf_touch_deg : float
        Angle of the base at first touch on CF, in degrees.
    """

    samples: xr.Dataset
    events: xr.Dataset
    lost_nj: float
    dissipated_nj: float
    cf_touch_deg: float


@dataclass(frozen=True)
class Texture:
    """Course of a whisker behind a rough surface.

    Attributes
    ----------
    samples : xarray.Dataset
        State at each of the times, by `time_s`: `phase` ("stuck", "slipping", "free", "undecided"), `asperity`, positions of the contact
        and of the tip, loads and energy. NaN without an asperity, or where a sample is undecided for the `reason`.
    events : xarray.Dataset
        Touches, releases, slip-offs and pull-offs between samples, by `number`.
    stays : xarray.Dataset
        Stays on asperities with their dwell times, by `number`; the end is NaN if a stay lasts to the end of the course.
    histogram : xarray.Dataset
        Time that the tip spends in bins along the surface, by `bin`.
    lost_nj : float
        Energy that the detachments lose, in nJ; NaN if one is not known.
    reached : int
        Number of asperities within reach of the resting whisker.
    """

    samples: xr.Dataset
    events: xr.Dataset
    stays: xr.Dataset
    histogram: xr.Dataset
    lost_nj: float
    reached: int


def whisk(
    scene: Scene,
    distance_mm: float,
    time_s: ArrayLike,
    angle_deg: ArrayLike,
    *,
    start: Literal["contact", "free"] | None = None,
    bridge_s: float = 0,
    curvature_at_mm: float | None = None,
) -> Whisk:
    """Compute the quasi-static course of a whisker whose base rotates in front of one pole.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker. Its grid is not used.
    distance_mm : float
        Distance from the base to the contact at first touch on CB.
    time_s : array_like
        Times of the samples in s, which grow; at least two.
    angle_deg : array_like
        Angle of the base at each of the times: 0 at first touch on CB, growing with the push there. It changes along straight lines
        between samples. NaN, None, NA or masked where it is missing: that sample has no state. After such a gap the course is undecided
        until only one state is possible.
    start : {"contact", "free"}, optional
        State at the first angle that is not missing. In "contact", the base has pushed the whisker there from first touch: on CB if that side holds it, otherwise
        on CF. A "free" whisker beyond first touch has passed the pole; that is assumed, with a warning, if left out.
    bridge_s : float
        Longest gap, in s, across which the course continues along a straight line: the time between the angles before and after missing
        ones. 0 bridges none.
    curvature_at_mm : float, optional
        Arclength from the base, in mm, at which the samples have `curvature_per_mm`.

    Raises
    ------
    ValueError
        If the times do not grow, an angle is beyond a turn, `bridge_s` is negative, or the whisker cannot be in the state at the start. If arrays of
        xarray or series of pandas have other dimensions or labels at the same places.
    StateError
        If the resting whisker does not reach the pole.
    SceneError
        If the scene allows no pole at this distance.
    RuntimeError
        If a detachment is not found.

    Warns
    -----
    SceneWarning
        If a free whisker beyond first touch is assumed, gaps are bridged or not, or samples are undecided.
    """
    checked, distance = _checked(scene), number("distance_mm", distance_mm)
    check_labels({"time_s": time_s, "angle_deg": angle_deg})
    course = (real_array("time_s", time_s), real_array_or_nan("angle_deg", angle_deg))
    time, angle = _one_dimensional(*course)
    samples, events, lost, dissipated, cf_touch, warnings = _whiskmap.whisk(
        checked, distance, (time, angle), start, number("bridge_s", bridge_s), _optional("curvature_at_mm", curvature_at_mm)
    )
    warn(warnings)
    about = {"distance_mm": distance}
    return Whisk(_over_time(samples, scene, about), _numbered(events, scene, about), lost, dissipated, cf_touch)


def texture(scene: Scene, time_s: ArrayLike, angle_deg: ArrayLike, *, curvature_at_mm: float | None = None) -> Texture:
    """Compute the quasi-static course of a whisker whose base sweeps behind the scene's rough surface.

    The paper has no model for this. Inertia and friction are left out, and one asperity at a time bends the whisker.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker with a `surface`, without friction. Its pole and its grid are not used.
    time_s : array_like
        Times of the samples in s, which grow; at least two.
    angle_deg : array_like
        Angle of the base at each of the times, -90 to 90: 0 where the chord of the resting whisker is normal to the surface.
    curvature_at_mm : float, optional
        Arclength from the base, in mm, at which the samples have `curvature_per_mm`.

    Raises
    ------
    ValueError
        If the scene has no surface or has friction, the whisker does not fit between asperities, or the course is refused. If arrays of xarray or
        series of pandas have other dimensions or labels at the same places.
    RuntimeError
        If a detachment is not found.
    """
    check_labels({"time_s": time_s, "angle_deg": angle_deg})
    time, angle = _one_dimensional(real_array("time_s", time_s), real_array("angle_deg", angle_deg))
    samples, events, stays, histogram, lost, reached, warning = _whiskmap.texture(
        _checked(scene), time, angle, _optional("curvature_at_mm", curvature_at_mm)
    )
    warn([warning])
    bins = xr.Dataset(variables(histogram, ("bin",), (-1,)), rest_coords(scene), attributes(scene))
    return Texture(_over_time(samples, scene), _numbered(events, scene), _numbered(stays, scene), bins, lost, reached)


def force(
    scene: Scene,
    frames: str | os.PathLike[str] | Mapping[str, Any],
    *,
    model: bool = False,
    baseline_s: tuple[float, float] | None = None,
    columns: Mapping[str, str] | None = None,
    axis: str = "tangent",
) -> xr.Dataset:
    """Compute the contact force in frames of a film from the change of curvature at one point of the whisker.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker without friction. Its grid is not used.
    frames : path, mapping or pandas.DataFrame
        A CSV file, or columns of equal length: `time_s`, `curvature_per_mm`, `at_arc_length_mm`, `contact_x_mm`, `contact_y_mm` in the
        frame of the base with the first axis `axis`, and without `model` also `contact_angle_deg`; if known `at_x_mm` and `at_y_mm`. The position of the contact
        is missing in frames without contact, or a column `contact` is 0 there and 1 elsewhere. Missing numbers are NaN, None, NA or
        masked.
    model : bool
        True computes the stable state of the full model that has this curvature, instead of the moment over the lever.
    baseline_s : tuple of float, optional
        First and last time, in s, of frames without contact. The curvature changes from their mean. Without it, the frames whose `contact`
        is 0 are the baseline, if at least two of them have a curvature.
    columns : mapping of str, optional
        Own names of columns by the expected ones, such as ``{"time_s": "t"}``. An expected name may be shortened at an underscore.
    axis : str
        First axis of the frame of the base, in the frames and in the dataset: "tangent", that of the whisker at the base, as a film shows it,
        or "follicle", the axis of the follicle, as in all other datasets. Without a follicle they are one.

    Returns
    -------
    xarray.Dataset
        Force, and force and moment at the base, by `time_s`. NaN with a `reason` ("missing", "no-lever", "out-of-reach", "no-state")
        where a frame has no force. `force_sd_un` and the other standard deviations are of first order. They come from the scatter of the
        baseline, and from `curvature_sd_per_mm` (instead of the scatter), `contact_sd_mm` and `angle_sd_deg` of the scene's `uncertainty`.
        The attributes `baseline_per_mm`, `baseline_sd_per_mm` and `baseline_frames` report the baseline.

    Raises
    ------
    ValueError
        If a column is missing, a value is out of its range, times do not grow, the scene has friction, or `baseline_s` has a frame in
        contact, or fewer than two frames with a curvature.
    OSError
        If the file cannot be read.
    """
    checked, span = _checked(scene), None
    if baseline_s is not None:
        ends = numbers("baseline_s", baseline_s)
        if len(ends) != 2 or not ends[0] < ends[1]:
            raise ValueError(f"baseline_s = {baseline_s!r}: must be a first and a later last time, in s")
        span = (ends[0], ends[1])
    with naming_rows("frames", frames):
        text, origin = csv_text("frames", frames), origin_of("frames", frames)
        found, warnings, baseline = _whiskmap.force(checked, text, origin, own_names(columns), bool(model), span, axis)
    warn(warnings)
    names = ("baseline_per_mm", "baseline_sd_per_mm", "baseline_frames")
    return _over_time(found, scene, dict(zip(names, baseline or ())))


def _optional(name: str, value: Any) -> float | None:
    return None if value is None else number(name, value)


def _one_dimensional(*arrays: Any) -> tuple[Any, ...]:
    for name, array in zip(("time_s", "angle_deg"), arrays):
        if array.ndim != 1:
            raise ValueError(f"{name}: must have one dimension, has {array.ndim}")
    return arrays


def _over_time(columns: Iterable[_Column], scene: Scene, about: Mapping[str, Any] | None = None) -> xr.Dataset:
    own = variables(columns, ("time_s",), (-1,))
    return xr.Dataset(own, rest_coords(scene), attributes(scene) | dict(about or {})).set_coords("time_s")


def _numbered(columns: Iterable[_Column], scene: Scene, about: Mapping[str, Any] | None = None) -> xr.Dataset:
    own = variables(columns, ("number",), (-1,))
    return xr.Dataset(own, rest_coords(scene), attributes(scene) | dict(about or {}))
