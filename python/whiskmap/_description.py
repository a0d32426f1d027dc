"""Descriptions of scenes: plain values, from which the extension builds checked scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import astuple
from typing import Any

from whiskmap._parts import Range, Surface, axis_of
from whiskmap._values import number
from whiskmap._whiskmap import CheckedScene, parameters

_AXES = {name: axis for name, _, axis, _ in parameters() if axis is not None}
_TIPS = ("taper", "tip_radius_um")
PARAMETERS = {axis: name for name, axis in _AXES.items()} | {name: name for name, *_ in parameters()}


def range_of(values: Any) -> Range | list[float]:
    """An axis of a description."""
    if isinstance(values, tuple):
        first, last, count, scale = values
        return [first] if last is None else Range(first, last, count, scale)
    return list(values)


def build(
    title: str,
    given: Mapping[str, float | None],
    measured: tuple[Any, bool],
    rest: tuple[Any, int | None],
    axes: Mapping[str, Any],
    uncertainty: Mapping[str, float] | None,
    surface: Surface | None,
    table: Any,
    name: str | None,
    changed: Iterable[str] = (),
) -> CheckedScene:
    """Check the plain values of a scene. `measured` is the rows of radii and whether they are smoothed, `rest` the traced points with their degree.
    `changed` names numbers that no column of the table may give."""
    for argument, text in (("title", title), ("name", name)):
        if not isinstance(text, str):
            raise TypeError(f"{argument} = {text!r}: must be a text")
    if surface is not None and not isinstance(surface, Surface):
        raise TypeError(f"surface = {surface!r}: must be a Surface")
    deviations = None
    if uncertainty is not None:
        if not isinstance(uncertainty, Mapping):
            raise TypeError(f"uncertainty = {uncertainty!r}: must be a mapping of names to standard deviations")
        deviations = {own: number(f"uncertainty[{own!r}]", value) for own, value in uncertainty.items()}
    listed = [
        (own, (values.first, values.last, values.count, values.scale) if isinstance(values, Range) else values)
        for own, values in axes.items()
    ]
    present = {own: value for own, value in given.items() if value is not None}
    rows, smooth = measured
    if rows is None and smooth:
        raise ValueError("profile_smooth = True: must be left out without profile")
    profile = None if rows is None else ([list(row) for row in rows], smooth)
    points, degree = rest
    if points is None and degree is not None:
        raise ValueError(f"rest_degree = {degree}: must be left out without rest_points")
    traced = None if points is None else ([list(point) for point in points], degree)
    rough = None if surface is None else astuple(surface)
    return CheckedScene.build((title, present, profile, traced, listed, deviations, rough, table, name), set(changed))


def set_parameter(parameter: str, value: Any, given: dict[str, Any], axes: dict[str, Any]) -> None:
    """Set or sweep a parameter. A taper replaces the radius at the tip, and the reverse."""
    for own in _TIPS if parameter in _TIPS else (parameter,):
        axes.pop(_AXES.get(own, own), None)
        if own in _TIPS or value is None:
            given.pop(own, None)
    is_list = hasattr(value, "__len__") and getattr(value, "ndim", 1) > 0 and not isinstance(value, (str, bytes))
    if is_list or isinstance(value, Range):
        if parameter not in _AXES:
            raise TypeError(f"{parameter}: must be a number, as no axis varies it")
        axes[_AXES[parameter]] = axis_of(parameter, value)
    elif value is not None:
        given[parameter] = number(parameter, value)


def order_of(changes: Mapping[str, Any]) -> list[str]:
    """Return the names of changes in an order that does not depend on theirs, if no two of them set one number."""
    known = list(PARAMETERS)
    names = sorted(changes, key=lambda name: (known.index(name) if name in PARAMETERS else -1, name))
    numbers: dict[str, str] = {}
    for name in names:
        parameter = PARAMETERS.get(name, name)
        other = numbers.setdefault(_TIPS[0] if parameter in _TIPS else parameter, name)
        if other != name:
            raise TypeError(f"{other} and {name}: give one of them, because both set one number")
    return names


def resembling(name: str, known: Mapping[str, str] = PARAMETERS) -> str:
    """Return a hint at the known name that resembles this one, by default at a parameter, or an empty text."""
    from difflib import get_close_matches

    found = get_close_matches(name, known, n=1)
    return f"; did you mean {known[found[0]]!r}?" if found else ""
