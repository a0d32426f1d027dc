"""Detachments of many whiskers at many distances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from whiskmap import _whiskmap
from whiskmap._maps import _checked
from whiskmap._description import PARAMETERS, resembling
from whiskmap._scene import Scene
from whiskmap._values import check_labels, real_array, refuse_masked, side_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_KINDS = np.array(["slip-off", "pull-off", "out-of-reach", "unresolved", "no-whisker"])


@dataclass(frozen=True)
class Detachment:
    """Ends of pushes, as arrays of the shape to which the arguments of `detachment` broadcast.

    Values are NaN where there is no detachment.

    Attributes
    ----------
    kind : array of str
        "slip-off", "pull-off", "out-of-reach" (the resting whisker does not reach the pole), "unresolved", or "no-whisker" (a value is
        missing or refused).
    push_angle_deg : array of float
        Rotation of the base since first touch: positive CB, negative CF.
    push_chord_deg : array of float
        Angle at the base between the contact and the resting whisker as far away.
    contact_distance_mm, arc_length_mm : array of float
        Straight distance, and arclength, from the base to the contact.
    contact_angle_deg : array of float
        Angle of the tangent at the contact, from the base's tangent.
    force_un : array of float
        Normal part of the force between pole and whisker; never negative.
    contact_force_un : array of float
        Size of the whole force between pole and whisker, with friction.
    base_force_x_un, base_force_y_un, base_moment_nnm : array of float
        Force that the pole puts on the base, along and to the left of its tangent, and its moment.
    energy_nj : array of float
        Bending energy of the whisker.
    residual : array of float
        Remaining error, relative to the distance of the pole.
    snaps_deg : array of float
        Push angle up to which other stable states exist at this end: the whisker may snap there. NaN without such states.
    variables : tuple of str
        Names of the variables of `jac`.
    jac : dict of str to array of float
        Exact derivatives of each quantity by name, of the shape of the quantity and one axis more, `variables`. Units are those of
        the names, such as degrees per um. NaN where slip-off turns into pull-off, and where the push ends at first touch.
    refused : dict of tuple of int to str
        Reasons of the elements without a whisker, by their indices.
    max_strain : array of float or None
        Largest bending strain of the push until it ends; None if the scene has no yield strain.
    yields : array of bool or None
        True where the largest strain of the push exceeds the yield strain of the scene; None without one.
    """

    kind: NDArray[np.str_]
    push_angle_deg: NDArray[np.float64]
    push_chord_deg: NDArray[np.float64]
    contact_distance_mm: NDArray[np.float64]
    arc_length_mm: NDArray[np.float64]
    contact_angle_deg: NDArray[np.float64]
    force_un: NDArray[np.float64]
    contact_force_un: NDArray[np.float64]
    base_force_x_un: NDArray[np.float64]
    base_force_y_un: NDArray[np.float64]
    base_moment_nnm: NDArray[np.float64]
    energy_nj: NDArray[np.float64]
    residual: NDArray[np.float64]
    snaps_deg: NDArray[np.float64]
    variables: tuple[str, ...]
    jac: dict[str, NDArray[np.float64]]
    refused: dict[tuple[int, ...], str]
    max_strain: NDArray[np.float64] | None = None
    yields: NDArray[np.bool_] | None = None


def detachment(
    scene: Scene | None = None,
    /,
    *,
    distance_mm: ArrayLike,
    side: Literal["both", "cb", "cf"] | ArrayLike = "both",
    jac: bool | Sequence[str] = False,
    strict: bool = False,
    threads: int | None = None,
    **parameters: ArrayLike,
) -> Detachment:
    """Compute where whiskers detach. All arrays broadcast against each other by place, as in numpy.

    Parameters
    ----------
    scene : Scene, optional
        A scene of one whisker, with the values of all parameters that are not given. Its grid is not used.
    distance_mm : array_like
        Distances from the base to the contact at first touch.
    side : {"both", "cb", "cf"} or array_like of str
        Side of the whisker that the pole is on: convex or concave, in capitals or not. "both" adds an axis of two values at the end: CF,
        then CB.
    jac : bool or sequence of str
        Variables of the derivatives: names of parameters, and "distance_mm". True selects all parameters that are given here, in
        their order. A variable varies with all other values fixed that are given: with `taper`, the radius at the base varies at
        a fixed taper.
    strict : bool
        True refuses all if one element is refused or NaN. Otherwise these elements are "no-whisker", and `refused` has the reasons.
    threads : int, optional
        Number of threads; one for each core if left out.
    **parameters : array_like
        Parameters of whisker and pole by name, in the units of the names, such as `taper` or `pole_radius_mm`. Without a scene,
        `length_mm`, `base_radius_um`, `youngs_modulus_gpa`, and `tip_radius_um` or `taper` are needed.

    Returns
    -------
    Detachment
        Arrays of the common shape.

    Raises
    ------
    TypeError
        If a name is unknown, or values are no real numbers.
    SceneError
        If a value of all elements is out of its range, or with `strict` of one: the message names the argument, the index and the value.
    ValueError
        If the arguments do not broadcast, or a value is masked or infinite, or with `strict` NaN. If arrays of xarray, or series or data
        frames of pandas, have other dimensions or labels at the same axis, counted from the last.

    Examples
    --------
    >>> import numpy as np
    >>> import whiskmap as wm
    >>> taper = np.linspace(0.5, 1, 3)
    >>> cone = dict(length_mm=20, base_radius_um=30, youngs_modulus_gpa=3, parabola_per_mm=0.02, pole_radius_mm=0.25)
    >>> end = wm.detachment(taper=taper[:, None], distance_mm=[12, 15.66], side="cb", **cone)
    >>> end.push_angle_deg.shape
    (3, 2)

    Residuals and Jacobian of a fit of two parameters, as `scipy.optimize.least_squares` takes them:

    >>> scene = wm.Scene.read("scenes/cone.toml")  # doctest: +SKIP
    >>> def end(x):  # doctest: +SKIP
    ...     return wm.detachment(scene, distance_mm=d, side=sides, tip_radius_um=x[0], parabola_per_mm=x[1], jac=True)
    >>> least_squares(  # doctest: +SKIP
    ...     lambda x: end(x).push_angle_deg - measured, [3.0, 0.02], jac=lambda x: end(x).jac["push_angle_deg"]
    ... )
    """
    arrays: dict[str, NDArray[Any]] = {"distance_mm": real_array("distance_mm", distance_mm)}
    if {"taper", "tip_radius_um"} <= parameters.keys():
        raise TypeError("taper and tip_radius_um: give one of them, because taper is 1 - tip_radius_um / base_radius_um")
    for name, values in parameters.items():
        if PARAMETERS.get(name) != name:
            raise TypeError(f"detachment() got an unexpected keyword argument {name!r}{resembling(name)}")
        arrays[name] = real_array(name, values)
    check_labels({"distance_mm": distance_mm, **parameters, "side": side})
    for name, array in arrays.items():
        is_allowed = np.isfinite(array) if strict else ~np.isinf(array)
        if not is_allowed.all():
            place = np.unravel_index(int(np.argmin(is_allowed)), array.shape)
            raise ValueError(f"{name}{list(map(int, place)) or ''} = {array[place]}: must be finite")
    variables = _variables(jac, tuple(parameters))
    is_cb = _is_cb(side)
    has_both = isinstance(side, str) and side.lower() == "both"
    shape = _shape(arrays if has_both else arrays | {"side": is_cb})
    if has_both:
        arrays = {name: array[..., None] for name, array in arrays.items()}
        shape += is_cb.shape
    single = {name: float(array.flat[0]) for name, array in arrays.items() if name != "distance_mm" and array.size == 1}
    fixed = {name: value for name, value in single.items() if not np.isnan(value)}
    flat = {name: np.broadcast_to(array, shape).ravel() for name, array in arrays.items() if name not in fixed}
    missing = {int(place): f"{name} is missing" for name, array in flat.items() for place in np.flatnonzero(np.isnan(array))}
    present = np.setdiff1d(np.arange(flat["distance_mm"].size), np.array(list(missing), dtype=np.intp))
    kinds, residual, snaps, strains, quantities, refused = _whiskmap.detachment(
        None if scene is None else _checked(scene),
        fixed,
        {name: array[present] for name, array in flat.items() if name != "distance_mm"},
        flat["distance_mm"][present],
        np.broadcast_to(is_cb, shape).ravel()[present],
        variables,
        threads,
    )
    for why in refused:
        why.element = int(present[why.element])
    named = {why.element: _named(why, arrays, shape, has_both) for why in refused}
    if named and (strict or len(named) == present.size):
        raise named[min(named)]
    reasons = missing | {element: str(why) for element, why in named.items()}

    def full(values: NDArray[Any], rest: Any, *more: int) -> NDArray[Any]:
        array = np.full((flat["distance_mm"].size, *more), rest, dtype=values.dtype)
        array[present] = values.reshape((present.size, *more))
        return array.reshape((*shape, *more))

    most = None if scene is None else _checked(scene).yield_strain()
    max_strain = None if strains is None else full(strains, np.nan)
    return Detachment(
        kind=_KINDS[full(kinds, len(_KINDS) - 1)],
        residual=full(residual, np.nan),
        snaps_deg=full(snaps, np.nan),
        max_strain=max_strain,
        yields=None if max_strain is None else np.asarray(max_strain > most),
        variables=variables,
        jac={name: full(by, np.nan, len(variables)) for name, _, by in quantities} if variables else {},
        refused={tuple(map(int, np.unravel_index(own, shape))): reasons[own] for own in sorted(reasons)},
        **{name: full(values, np.nan) for name, values, _ in quantities},
    )


def _variables(jac: bool | Sequence[str], given: tuple[str, ...]) -> tuple[str, ...]:
    if isinstance(jac, (bool, np.bool_)):
        return given if jac else ()
    if isinstance(jac, str) or not all(isinstance(name, str) for name in jac):
        raise TypeError(f"jac = {jac!r}: must be True, False or a list of names")
    return tuple(jac)


def _is_cb(side: Any) -> NDArray[np.bool_]:
    """True for CB, False for CF; "both" is one axis of both."""
    if isinstance(side, str):
        return np.array([False, True]) if side_of(side) == "both" else np.array(side_of(side) == "cb")
    refuse_masked("side", side)
    sides = np.asarray(side)
    lower = np.array([own.lower() if isinstance(own, str) else "" for own in sides.ravel()], dtype=np.str_).reshape(sides.shape)
    is_wrong = ~np.isin(lower, ["cb", "cf"])
    if is_wrong.any():
        place = np.unravel_index(int(np.argmax(is_wrong)), sides.shape)
        value = sides[place] if sides.dtype.kind == "O" else sides[place].item()
        raise ValueError(f"side{list(map(int, place)) or ''} = {value!r}: must be 'cb' or 'cf'")
    return np.asarray(lower == "cb")


def _named(why: _whiskmap.SceneError, arrays: dict[str, NDArray[Any]], shape: tuple[int, ...], has_both: bool) -> _whiskmap.SceneError:
    """Return the error of an element with the name of its argument and its index there; of a scalar, as it is."""
    name = (why.key or "").rpartition(".")[2].partition("[")[0]
    element = [int(index) for index in np.unravel_index(why.element, shape)]
    if name in arrays:
        array = arrays[name]
        own = [index if size > 1 else 0 for index, size in zip(element[len(element) - array.ndim :], array.shape)]
        own = own[:-1] if has_both else own
        text = f"{name}{own or ''} = {why.value}: {why.allowed}"
    else:
        element = element[:-1] if has_both else element
        text = f"element {element}: {why}" if element else str(why)
    named = _whiskmap.SceneError(text)
    named.key, named.value, named.allowed = why.key, why.value, why.allowed
    return named


def _shape(arrays: dict[str, NDArray[Any]]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items() if array.ndim)
        raise ValueError(f"the arguments do not broadcast: {shapes}") from None
