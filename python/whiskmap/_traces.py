"""Detachment curves, branches and shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import xarray as xr

from whiskmap import _whiskmap
from whiskmap._datasets import attributes, rest_coords, row, scene_coords, variables
from whiskmap._detachment import detachment
from whiskmap._maps import _checked
from whiskmap._scene import Scene
from whiskmap._values import number, real_array, side_of
from whiskmap._warnings import warn

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Side = Literal["both", "cb", "cf"]


def curve(scene: Scene, *, tolerance_deg: float | None = None, threads: int | None = None) -> xr.Dataset:
    """Compute where every whisker of a scene detaches, at each distance and on both sides.

    Parameters
    ----------
    scene : Scene
        Its push angles are not used.
    tolerance_deg : float, optional
        Maximum error of push angles, in degrees; the finest steps if left out.
    threads : int, optional
        Number of threads; one for each core if left out.

    Returns
    -------
    xarray.Dataset
        Dimensions are the sweep axes, `side` ("cf", "cb") and `distance_mm`. `kind` is "slip-off", "pull-off", "out-of-reach",
        "unresolved", or "no-whisker" for a row of a table without a whisker; without a detachment the quantities are NaN. `to_dataframe()` is the table of `whiskmap curve`.

    Raises
    ------
    ValueError
        If the tolerance cannot be kept.
    KeyboardInterrupt
        On Ctrl-C.
    """
    columns = _whiskmap.curve(_checked(scene), tolerance_deg, threads)
    coords = scene_coords(scene)
    del coords["push_angle_deg"]
    distance = coords.pop("distance_mm")
    coords |= {"side": xr.Variable("side", ["cf", "cb"]), "distance_mm": distance}
    shape = [own.size for own in coords.values()]
    own = variables(columns, tuple(coords), shape, without=("side", "distance_mm"))
    kind = own["kind"].values
    unresolved = np.count_nonzero(kind == "unresolved")
    warn([f"{unresolved} of {kind.size} ends are unresolved: see the variable `kind`"] if unresolved else [])
    return xr.Dataset(own, coords | rest_coords(scene), attributes(scene))


def branch(scene: Scene, distance_mm: float, side: Side = "cb", *, points: int = 200) -> xr.Dataset:
    """Compute all states at one pole: stable ones from first touch to the fold, then unstable ones.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker. Its grid is not used.
    distance_mm : float
        Distance from the base to the contact at first touch.
    side : {"both", "cb", "cf"}
        Side of the whisker that the pole is on: convex or concave. "both" adds a dimension `side`: CF, then CB.
    points : int
        Number of points, evenly spaced along the branch.

    Returns
    -------
    xarray.Dataset
        One dimension, `point`. `stable` tells the two parts apart, and `mark` names special points.

    Raises
    ------
    StateError
        If the resting whisker does not reach the pole.
    SceneError
        If the scene allows no pole at this distance.
    RuntimeError
        If the continuation fails.
    """
    distance = number("distance_mm", distance_mm)
    checked, both = _checked(scene), side_of(side)
    about = attributes(scene) | {"distance_mm": distance}
    sides = ["cf", "cb"] if both == "both" else [both]
    branches = []
    for own in sides:
        columns = _whiskmap.branch(checked, distance, own, points)
        found = variables(columns, ("point",), (-1,), without=("side", "distance_mm"))
        branches.append(xr.Dataset(found, rest_coords(scene), about | {"side": own}))
    if both == "both":
        return xr.concat(branches, xr.Variable("side", sides), coords="minimal", compat="override").assign_attrs(side=both)
    return branches[0]


def shape(
    scene: Scene, distance_mm: float, push_angle_deg: float, *, stable: bool = True, points: int = 200
) -> xr.Dataset:
    """Compute the shape of the whisker after a push.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker. Its grid is not used.
    distance_mm : float
        Distance from the base to the contact at first touch.
    push_angle_deg : float
        Rotation of the base since first touch: positive CB, negative CF.
    stable : bool
        False selects the unstable state beyond the fold.
    points : int
        Number of points, evenly spaced along the whisker; the contact is one more.

    Returns
    -------
    xarray.Dataset
        One dimension, `point`, from base to tip. Positions are in the frame of the base at first touch. Attributes are the
        centre of the pole (`pole_x_mm`, `pole_y_mm`), its radius, and the forces, moment and energy of the state.

    Raises
    ------
    StateError
        If there is no such state: the message says how the whisker left the pole, and at which push angle.
    SceneError
        If the scene allows no pole at this distance.
    """
    distance, push = number("distance_mm", distance_mm), number("push_angle_deg", push_angle_deg)
    columns, pole, radius, residual, state = _whiskmap.shape(_checked(scene), distance, push, stable, points)
    own = variables(columns, ("point",), (-1,))
    about: dict[str, Any] = {"pole_x_mm": pole[0], "pole_y_mm": pole[1], "pole_radius_mm": radius, "residual": residual}
    return xr.Dataset(own, rest_coords(scene), attributes(scene) | about | dict(row(state, without=("stable",))))


def sensitivity(scene: Scene, distance_mm: ArrayLike | None = None, *, threads: int | None = None) -> xr.Dataset:
    """Compute the exact derivatives of detachments by every number of a scene, and by the distance.

    Parameters
    ----------
    scene : Scene
        A scene of one whisker.
    distance_mm : array_like, optional
        Distances from the base to the contact at first touch; those of the scene if left out.
    threads : int, optional
        Number of threads; one for each core if left out.

    Returns
    -------
    xarray.Dataset
        The quantities of `detachment` by `side` and `distance_mm`, and their derivatives `d_push_angle_deg`, `d_force_un` and so on by
        `variable`, too. Coordinates of the variables are `value` and `units`. `d_push_angle_deg * value / 100` is the change for 1 %.
        The radius at the base varies at a fixed radius at the tip. NaN where there is no derivative.

    Raises
    ------
    SceneError
        If the scene allows no pole at a distance.
    """
    checked = _checked(scene)
    distances = scene.coords["distance_mm"] if distance_mm is None else real_array("distance_mm", distance_mm)
    distances = np.atleast_1d(distances)
    if distances.ndim != 1:
        raise ValueError(f"distance_mm: must have one dimension, has {distances.ndim}")
    names, units, values = zip(*_whiskmap.variables(checked))
    ends = detachment(scene, distance_mm=distances[:, None], side=["cf", "cb"], jac=names, threads=threads)
    own = {"kind": xr.Variable(("distance_mm", "side"), ends.kind)}
    for name, by in ends.jac.items():
        own[name] = xr.Variable(("distance_mm", "side"), getattr(ends, name))
        own[f"d_{name}"] = xr.Variable(("distance_mm", "side", "variable"), by)
    of_variable = {"variable": list(names), "value": ("variable", list(values)), "units": ("variable", list(units))}
    coords = {"distance_mm": distances, "side": ["cf", "cb"], **of_variable, **rest_coords(scene)}
    return xr.Dataset(own, coords, attributes(scene)).transpose("variable", "side", "distance_mm", missing_dims="ignore")
