"""Parts of scenes: whiskers, poles, grids and surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Literal, Union

from whiskmap._values import check_columns, is_missing, number, number_or_nan, numbers, text_of, unique_names, whole
from whiskmap._warnings import warn
from whiskmap._whiskmap import parameters, unused_columns

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Columns of numbers of a table of whiskers.
_NUMBERS = {column for name, _, axis, _ in parameters() for column in (name, axis) if column} | {"yield_strain"}

# Columns of the numbers that come in pairs.
PAIRS = {"profile": ("arc_length_mm", "radius_um"), "rest_points": ("x_mm", "y_mm")}


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
        Number of values, 1 to 65,536.
    scale : {"linear", "log"}
        Equal differences or equal ratios of neighbouring values.

    Raises
    ------
    TypeError
        If the count is not a whole number.
    ValueError
        If the count is less than 1.
    """

    first: float
    last: float
    count: int
    scale: Literal["linear", "log"] = "linear"

    def __post_init__(self) -> None:
        set_field(self, "count", whole("count", self.count))
        if self.count < 1:
            raise ValueError(f"count = {self.count}: must be at least 1")

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
        Young's modulus at the base. It scales forces, moments and energies, and no angle unless the follicle turns.
    base_radius_um, tip_radius_um : float, optional
        Radii at base and tip; needed without `profile`.
    taper : float, optional
        1 - tip radius / base radius, instead of `tip_radius_um`: 0 is a cylinder, 1 a perfect cone.
    profile : array_like or pandas.DataFrame, optional
        Measured rows of arclength (mm) and radius (um), of shape (rows, 2), or columns `arc_length_mm` and `radius_um`, instead of the
        radii.
    profile_smooth : bool
        Whether a polynomial through the measured rows replaces their radii. Cross-validation chooses its degree from 0 to 6; `profile_fit` of
        the scene reports it.
    profile_scale, tip_extension_mm : float, optional
        Factor of the measured radii; length of the cone that continues the last two rows.
    parabola_per_mm, vertex_mm : float, optional
        Resting shape ``y = A (x - vertex)^2``; straight if left out.
    spiral_per_mm, spiral_per_mm2 : float, optional
        Resting shape as an Euler spiral: curvature at the base, and its growth along the whisker.
    rest_points : array_like or pandas.DataFrame, optional
        Resting shape as points in mm that were traced from base to tip, of shape (points, 2), or columns `x_mm` and `y_mm`. A curve of
        polynomial curvature is fitted.
        It bends toward the CF side where it turns counterclockwise. A whisker of another length has the same shape at another scale.
    rest_degree : int, optional
        Degree of the curvature, 0 to 6; cross-validation chooses it if left out.
    modulus_tip_to_base, arc_stretch : float, optional
        Modulus at the tip over that at the base; real arclength over that in the plane of contact. Both are 1 if left out.
    follicle_stiffness_nnm_per_rad : float, optional
        Stiffness of the follicle, in which the base turns by the moment over the stiffness. The base is clamped if left out.
    yield_strain : float, optional
        Largest bending strain at the surface that the whisker bears elastically, more than 0 and at most 1. States beyond it are marked.
    """

    youngs_modulus_gpa: float
    length_mm: float | None = None
    base_radius_um: float | None = None
    tip_radius_um: float | None = None
    taper: float | None = None
    profile: Sequence[Sequence[float]] | NDArray[Any] | None = None
    profile_smooth: bool = False
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
    follicle_stiffness_nnm_per_rad: float | None = None
    yield_strain: float | None = None

    def __post_init__(self) -> None:
        for own in fields(self):
            value = getattr(self, own.name)
            if own.name in PAIRS:
                set_field(self, own.name, None if value is None else tuple(tuple(row) for row in pairs_of(own.name, value)))
            elif own.name == "rest_degree":
                set_field(self, own.name, degree_of(value))
            elif own.name == "profile_smooth":
                set_field(self, own.name, is_smooth(value))
            elif value is not None:
                set_field(self, own.name, number(own.name, value))


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
            set_field(self, own.name, number(own.name, getattr(self, own.name)))


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
            set_field(self, name, axis_of(name, getattr(self, name)))
        if not isinstance(self.sweep, Mapping):
            raise TypeError(f"sweep = {self.sweep!r}: must be a mapping of axes to their values")
        set_field(self, "sweep", {name: axis_of(name, values) for name, values in self.sweep.items()})


@dataclass(frozen=True, kw_only=True, repr=False)
class Surface(_Parts):
    """A rough surface: asperities, small poles without friction, on a line in front of the whisker.

    Parameters
    ----------
    distance_mm : float
        Smallest distance from the base to the line through the centres of the asperities.
    spacing_um : float
        Mean distance between the centres of neighbouring asperities.
    asperity_radius_um : float
        Radius of the asperities; 0 makes point contacts.
    length_mm : float
        Length of the line. Its middle is nearest to the base.
    jitter : float
        Width of the random shift of each asperity along the line, over the spacing: at least 0 and less than 1.
    seed : int
        Seed of the random shifts, less than 2**32. Equal seeds give equal surfaces.
    """

    distance_mm: float
    spacing_um: float
    asperity_radius_um: float
    length_mm: float
    jitter: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        for own in fields(self):
            value = getattr(self, own.name)
            if own.name != "seed":
                set_field(self, own.name, number(own.name, value))
            elif isinstance(value, bool) or not hasattr(value, "__index__") or not 0 <= value.__index__() < 2**32:
                raise TypeError(f"seed = {value!r}: must be a whole number from 0 to 4294967295")
            else:
                set_field(self, own.name, int(value.__index__()))


def set_field(own: object, name: str, value: object) -> None:
    object.__setattr__(own, name, value)


def pairs_of(name: str, pairs: Any) -> list[list[float]]:
    """Measured rows or traced points as lists of two numbers, from rows or from columns by name."""
    first, second = PAIRS[name]
    if hasattr(pairs, "keys"):
        if missing := [own for own in PAIRS[name] if own not in pairs.keys()]:
            raise ValueError(f"{name}: must have the columns {first} and {second}, has no {' and no '.join(missing)}")
        check_columns(name, {own: pairs[own] for own in PAIRS[name]})
        columns = [numbers(f"{name}[{own!r}]", pairs[own]) for own in PAIRS[name]]
        if len(columns[0]) != len(columns[1]):
            raise ValueError(f"{name}: columns must be equally long, have {len(columns[0])} and {len(columns[1])} numbers")
        return [list(pair) for pair in zip(*columns)]
    if isinstance(pairs, (str, bytes)) or not isinstance(pairs, Iterable):
        raise TypeError(f"{name} = {pairs!r}: must be rows of {first} and {second}, or these columns")
    rows = [numbers(f"{name}[{index}]", row) for index, row in enumerate(pairs)]
    for index, row in enumerate(rows):
        if len(row) != 2:
            raise ValueError(f"{name}[{index}]: must have 2 numbers, has {len(row)}")
    return rows


def rows_of(table: Any) -> list[Any] | None:
    """Rows of a table of whiskers, from columns or from rows: name, numbers by name, profile and traced points."""
    if table is None:
        return None
    if hasattr(table, "keys"):
        given = {str(own): table[own] for own in unique_names("table", table)}
        check_columns("table", given)
        columns = {own: list(values) for own, values in given.items()}
        counts = {len(values) for values in columns.values()}
        if len(counts) > 1:
            raise ValueError(f"table: columns must be equally long, have {' and '.join(map(str, sorted(counts)))} values")
        table = [dict(zip(columns, values)) for values in zip(*columns.values())]
    if isinstance(table, (str, bytes)) or not isinstance(table, Iterable):
        raise TypeError(f"table = {table!r}: must be a DataFrame, a mapping of columns, or a list of mappings")
    table = list(table)
    names = dict.fromkeys(str(own) for row in table if isinstance(row, Mapping) for own in row)
    unused = unused_columns(list(names))
    warn([None if unused is None else f"table: {unused}"])
    return [_row(f"table[{index}]", row) for index, row in enumerate(table)]


def _row(place: str, row: Any) -> tuple[str, list[tuple[str, float]], Any, Any]:
    if not isinstance(row, Mapping):
        raise TypeError(f"{place} = {row!r}: must be a mapping")
    if "name" not in row:
        raise ValueError(f"{place}: must have a name")
    numbers = [(own, number_or_nan(f"{place}[{own!r}]", value)) for own, value in row.items() if own in _NUMBERS]
    profile, points = (_pairs_or_none(f"{place}[{own!r}]", own, row.get(own)) for own in PAIRS)
    name = "" if is_missing(row["name"]) else text_of(f"{place}['name']", row["name"])
    return name, numbers, profile, points


def _pairs_or_none(place: str, name: str, value: Any) -> list[list[float]] | None:
    is_absent = not isinstance(value, Iterable) and math.isnan(number_or_nan(place, value))
    return None if is_absent else pairs_of(name, value)


def is_smooth(value: Any) -> bool:
    """Whether measured radii are smoothed."""
    if not isinstance(value, bool):
        raise TypeError(f"profile_smooth = {value!r}: must be True or False")
    return value


def degree_of(value: Any) -> int | None:
    """The degree of a traced curvature as a whole number that is not negative."""
    if value is None:
        return None
    if isinstance(value, bool) or not hasattr(value, "__index__") or value.__index__() < 0:
        raise TypeError(f"rest_degree = {value!r}: must be a whole number from 0 on")
    return int(value.__index__())


def axis_of(name: str, values: Any) -> Range | list[float]:
    if not isinstance(values, Range):
        return numbers(name, values)
    ends = (number(f"{name}.first", values.first), number(f"{name}.last", values.last))
    return Range(*ends, values.count, values.scale)
