"""Scenes: checked descriptions of whiskers, poles and grids."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Literal, Union

from whiskmap._values import number, numbers
from whiskmap._whiskmap import CheckedScene, coordinates, parameters

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_AXES = {name: axis for name, _, axis, _ in parameters() if axis is not None}
_TIPS = ("taper", "tip_radius_um")
_PAIRS = {"profile": "rows of arclength and radius", "rest_points": "points of x and y"}
_PARAMETERS = {axis: name for name, axis in _AXES.items()} | {name: name for name, *_ in parameters()}


class _Parts:
    """Values by name, whose representation can be pasted and leaves out what is left out."""

    def __repr__(self) -> str:
        given = ((own.name, getattr(self, own.name), own.default) for own in fields(self))  # type: ignore[arg-type]
        texts = (f"{name}={value!r}" for name, value, default in given if value != default and value != {})
        return f"{type(self).__name__}({', '.join(texts)})"


@dataclass(frozen=True)
class Range:
    """`count` values of an axis from `first` to `last`, both included.

    Parameters
    ----------
    first, last : float
        Ends of the range, in the unit of the axis.
    count : int
        Number of values, at most 65,536.
    scale : {"linear", "log"}
        Equal differences or equal ratios of neighbouring values.
    """

    first: float
    last: float
    count: int
    scale: Literal["linear", "log"] = "linear"

    def __repr__(self) -> str:
        scale = "" if self.scale == "linear" else f", {self.scale!r}"
        return f"Range({self.first!r}, {self.last!r}, {self.count!r}{scale})"


AxisLike = Union[Range, Sequence[float], "NDArray[Any]"]


@dataclass(frozen=True, kw_only=True, repr=False)
class Whisker(_Parts):
    """A whisker at rest. Names and units are those of a scene file; what is left out is not there.

    Parameters
    ----------
    length_mm : float, optional
        Arclength from base to tip; needed without `rest_points`. With them, it is that of the fitted curve if left out.
    youngs_modulus_gpa : float
        Young's modulus at the base. It scales forces, moments and energies, never an angle.
    base_radius_um, tip_radius_um : float, optional
        Radii at base and tip; needed without `profile`.
    taper : float, optional
        1 - tip radius / base radius, instead of `tip_radius_um`: 0 is a cylinder, 1 a perfect cone.
    profile : array_like, optional
        Measured rows of arclength (mm) and radius (um), of shape (rows, 2), instead of the radii.
    profile_scale, tip_extension_mm : float, optional
        Factor of the measured radii; length of the cone that continues the last two rows.
    parabola_per_mm, vertex_mm : float, optional
        Resting shape ``y = A (x - vertex)^2``; straight if left out.
    spiral_per_mm, spiral_per_mm2 : float, optional
        Resting shape as an Euler spiral: curvature at the base, and its growth along the whisker.
    rest_points : array_like, optional
        Resting shape as points in mm that were traced from base to tip, of shape (points, 2): a curve of polynomial curvature is fitted.
        It bends toward the CF side where it turns counterclockwise. A whisker of another length has the same shape at another scale.
    rest_degree : int, optional
        Degree of the curvature, 0 to 6; cross-validation chooses it if left out.
    modulus_tip_to_base, arc_stretch : float, optional
        Modulus at the tip over that at the base; real arclength over that in the plane of contact. Both are 1 if left out.
    """

    youngs_modulus_gpa: float
    length_mm: float | None = None
    base_radius_um: float | None = None
    tip_radius_um: float | None = None
    taper: float | None = None
    profile: Sequence[Sequence[float]] | NDArray[Any] | None = None
    profile_scale: float | None = None
    tip_extension_mm: float | None = None
    parabola_per_mm: float | None = None
    vertex_mm: float | None = None
    spiral_per_mm: float | None = None
    spiral_per_mm2: float | None = None
    rest_points: Sequence[Sequence[float]] | NDArray[Any] | None = None
    rest_degree: int | None = None
    modulus_tip_to_base: float | None = None
    arc_stretch: float | None = None

    def __post_init__(self) -> None:
        for own in fields(self):
            value = getattr(self, own.name)
            if own.name in _PAIRS:
                _set(self, own.name, None if value is None else tuple(tuple(row) for row in _rows(own.name, value)))
            elif own.name == "rest_degree":
                _set(self, own.name, _degree(value))
            elif value is not None:
                _set(self, own.name, number(own.name, value))


@dataclass(frozen=True, kw_only=True, repr=False)
class Pole(_Parts):
    """A pole in front of the whisker.

    Parameters
    ----------
    radius_mm : float
        Radius of the pole, in mm; 0 is a point contact.
    friction : float
        Coulomb's coefficient of friction, 0 to 1.
    """

    radius_mm: float = 0.0
    friction: float = 0.0

    def __post_init__(self) -> None:
        for own in fields(self):
            _set(self, own.name, number(own.name, getattr(self, own.name)))


@dataclass(frozen=True, kw_only=True, repr=False)
class Grid(_Parts):
    """Axes of a map. Values of an axis increase strictly.

    Parameters
    ----------
    push_angle_deg : Range or array_like
        Push angles, the rotations of the base since first touch: positive CB, negative CF.
    distance_mm : Range or array_like
        Distances from the base to the contact at first touch.
    sweep : mapping of str to Range or array_like, optional
        Axes along which whiskers differ, such as ``{"taper": Range(0, 1, 16), "curvature_per_mm": [0, 0.02]}``.
    """

    push_angle_deg: AxisLike
    distance_mm: AxisLike
    sweep: Mapping[str, AxisLike] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("push_angle_deg", "distance_mm"):
            _set(self, name, _axis(name, getattr(self, name)))
        if not isinstance(self.sweep, Mapping):
            raise TypeError(f"sweep = {self.sweep!r}: must be a mapping of axes to their values")
        _set(self, "sweep", {name: _axis(name, values) for name, values in self.sweep.items()})


class Scene:
    """A whisker, a pole and a grid that have passed every check. A scene does not change.

    Parameters
    ----------
    whisker : Whisker
    grid : Grid
    pole : Pole, optional
        A point contact without friction if left out.
    title : str, optional
        One line of text.
    name : str, optional
        Stem of the names of files that are written.
    uncertainty : mapping of str to float, optional
        Standard deviations of the scene's numbers, by name, such as ``{"tip_radius_um": 0.5}``.

    Raises
    ------
    SceneError
        If a value is out of its range or contradicts another one. `key`, `value` and `allowed` say which.
    """

    __slots__ = ("_checked",)
    _checked: CheckedScene

    def __init__(
        self,
        *,
        whisker: Whisker,
        grid: Grid,
        pole: Pole | None = None,
        title: str = "Whisker at a pole",
        name: str = "scene",
        uncertainty: Mapping[str, float] | None = None,
    ) -> None:
        pole = Pole() if pole is None else pole
        for argument, value, kind in (("whisker", whisker, Whisker), ("grid", grid, Grid), ("pole", pole, Pole)):
            if not isinstance(value, kind):
                raise TypeError(f"{argument} = {value!r}: must be a {kind.__name__}")
        given = {own.name: getattr(whisker, own.name) for own in fields(whisker) if own.name not in (*_PAIRS, "rest_degree")}
        given |= {"pole_radius_mm": pole.radius_mm or None, "friction": pole.friction or None}
        axes = {"push_angle_deg": grid.push_angle_deg, "distance_mm": grid.distance_mm, **grid.sweep}
        self._checked = _build(title, given, whisker.profile, (whisker.rest_points, whisker.rest_degree), axes, uncertainty, name)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Scene:
        """Read a scene file (TOML). A CSV file that it names is read beside it.

        Raises
        ------
        OSError
            If the file cannot be read.
        SceneError
            If it is no scene.
        """
        return cls._of(CheckedScene.read(os.fspath(path)))

    @classmethod
    def parse(cls, text: str, name: str = "scene") -> Scene:
        """Check the text of a scene file. `name` is that of the scene if the text gives none."""
        return cls._of(CheckedScene.parse(text, f"{name}.toml"))

    @classmethod
    def _of(cls, checked: CheckedScene) -> Scene:
        scene = cls.__new__(cls)
        scene._checked = checked
        return scene

    def replace(self, **changes: Any) -> Scene:
        """Return the scene with other values.

        Parameters
        ----------
        **changes
            A number sets a parameter, such as ``taper=0.5`` or ``pole_radius_mm=1``; it ends a sweep of it. A `Range`, a list or
            an array makes the parameter a sweep axis. None leaves a value out. Also `push_angle_deg`, `distance_mm`, `profile`,
            `rest_points`, `rest_degree`, `title`, `name` and `uncertainty`.
        """
        title, given, rows, traced, listed, uncertainty, name = self._checked.description()
        axes: dict[str, Any] = dict(listed)
        changed: dict[str, Any] = dict(given)
        texts: dict[str, Any] = {"title": title, "name": name, "uncertainty": uncertainty, "profile": rows}
        texts["rest_points"], texts["rest_degree"] = traced or (None, None)
        for key, value in changes.items():
            if key in texts:
                texts[key] = value
            elif key in ("push_angle_deg", "distance_mm"):
                axes[key] = _axis(key, value)
            elif key in _PARAMETERS:
                _replace(_PARAMETERS[key], value, changed, axes)
            else:
                raise TypeError(f"replace() got an unexpected keyword argument {key!r}{_resembling(key)}")
        rows, points = (None if texts[own] is None else _rows(own, texts[own]) for own in _PAIRS)
        is_dropped = points is None and "rest_degree" not in changes
        rest = (points, None if is_dropped else _degree(texts["rest_degree"]))
        return Scene._of(_build(texts["title"], changed, rows, rest, axes, texts["uncertainty"], texts["name"]))

    @property
    def title(self) -> str:
        """Title, one line of text."""
        return self._checked.description()[0]

    @property
    def name(self) -> str:
        """Stem of the names of files that are written."""
        return self._checked.description()[6] or ""

    @property
    def whisker(self) -> Whisker:
        """The whisker; a taper is given as the radius at the tip."""
        _, given, rows, traced, *_ = self._checked.description()
        points, degree = traced or (None, None)
        own = {name: value for name, value in given.items() if name not in ("pole_radius_mm", "friction")}
        return Whisker(**own, profile=rows, rest_points=points, rest_degree=degree)

    @property
    def pole(self) -> Pole:
        """The pole."""
        given = self._checked.description()[1]
        return Pole(radius_mm=given.get("pole_radius_mm", 0.0), friction=given.get("friction", 0.0))

    @property
    def grid(self) -> Grid:
        """The axes as they are given; `coords` has their values."""
        axes = {name: _range(values) for name, values in self._checked.description()[4]}
        return Grid(push_angle_deg=axes.pop("push_angle_deg"), distance_mm=axes.pop("distance_mm"), sweep=axes)

    @property
    def uncertainty(self) -> dict[str, float] | None:
        """Standard deviations by name, or None."""
        return self._checked.description()[5]

    @property
    def coords(self) -> dict[str, NDArray[np.float64]]:
        """Values of all axes by name, in the order of a map's dimensions."""
        return {name: values for name, _, values in coordinates(self._checked)}

    @property
    def warnings(self) -> list[str]:
        """One line for each number that looks like one in another unit."""
        return self._checked.warnings()

    def to_toml(self) -> str:
        """Return the text of a scene file: the one that was read, or one written from the values."""
        return self._checked.to_toml()

    def __repr__(self) -> str:
        parts = {name: getattr(self, name) for name in ("title", "whisker", "pole", "grid", "name", "uncertainty")}
        return f"Scene({', '.join(f'{name}={value!r}' for name, value in parts.items() if value is not None)})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._checked == other._checked

    def __hash__(self) -> int:
        return hash((self.title, self.name))

    def __reduce__(self) -> tuple[Any, tuple[str, str]]:
        return (Scene.parse, (self.to_toml(), self.name))


def _set(own: object, name: str, value: object) -> None:
    object.__setattr__(own, name, value)


def _rows(name: str, pairs: Any) -> list[list[float]]:
    """Measured rows or traced points as lists of two numbers."""
    if isinstance(pairs, (str, bytes)) or not isinstance(pairs, Iterable):
        raise TypeError(f"{name} = {pairs!r}: must be {_PAIRS[name]}")
    rows = [numbers(f"{name}[{index}]", row) for index, row in enumerate(pairs)]
    for index, row in enumerate(rows):
        if len(row) != 2:
            raise ValueError(f"{name}[{index}]: must have 2 numbers, has {len(row)}")
    return rows


def _degree(value: Any) -> int | None:
    """The degree of a traced curvature as a whole number that is not negative."""
    if value is None:
        return None
    if isinstance(value, bool) or not hasattr(value, "__index__") or value.__index__() < 0:
        raise TypeError(f"rest_degree = {value!r}: must be a whole number from 0 on")
    return int(value.__index__())


def _axis(name: str, values: Any) -> Range | list[float]:
    if not isinstance(values, Range):
        return numbers(name, values)
    if isinstance(values.count, bool) or not hasattr(values.count, "__index__"):
        raise TypeError(f"{name}.count = {values.count!r}: must be a whole number")
    ends = (number(f"{name}.first", values.first), number(f"{name}.last", values.last))
    return Range(*ends, max(values.count.__index__(), 0), values.scale)


def _range(values: Any) -> Range | list[float]:
    """An axis of a description."""
    if isinstance(values, tuple):
        first, last, count, scale = values
        return [first] if last is None else Range(first, last, count, scale)
    return list(values)


def _build(
    title: str,
    given: Mapping[str, float | None],
    rows: Any,
    rest: tuple[Any, int | None],
    axes: Mapping[str, Any],
    uncertainty: Mapping[str, float] | None,
    name: str | None,
) -> CheckedScene:
    for argument, text in (("title", title), ("name", name)):
        if not isinstance(text, str):
            raise TypeError(f"{argument} = {text!r}: must be a text")
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
    profile = None if rows is None else [list(row) for row in rows]
    points, degree = rest
    if points is None and degree is not None:
        raise ValueError(f"rest_degree = {degree}: must be left out without rest_points")
    traced = None if points is None else ([list(point) for point in points], degree)
    return CheckedScene.build((title, present, profile, traced, listed, deviations, name))


def _replace(parameter: str, value: Any, given: dict[str, Any], axes: dict[str, Any]) -> None:
    """Set or sweep a parameter. A taper replaces the radius at the tip, and the reverse."""
    for own in _TIPS if parameter in _TIPS else (parameter,):
        axes.pop(_AXES.get(own, own), None)
        if own in _TIPS or value is None:
            given.pop(own, None)
    is_list = hasattr(value, "__len__") and getattr(value, "ndim", 1) > 0 and not isinstance(value, (str, bytes))
    if is_list or isinstance(value, Range):
        if parameter not in _AXES:
            raise TypeError(f"{parameter}: must be a number, as no axis varies it")
        axes[_AXES[parameter]] = _axis(parameter, value)
    elif value is not None:
        given[parameter] = number(parameter, value)


def _resembling(name: str) -> str:
    from difflib import get_close_matches

    known = get_close_matches(name, _PARAMETERS, n=1)
    return f"; did you mean {known[0]!r}?" if known else ""
