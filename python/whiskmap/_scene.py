"""Scenes: checked descriptions of whiskers, poles and grids."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from whiskmap._description import PARAMETERS, build, order_of, range_of, resembling, set_parameter
from whiskmap._parts import PAIRS, Grid, Pole, Surface, Whisker, axis_of, degree_of, is_smooth, pairs_of, rows_of
from whiskmap._values import number, text_of
from whiskmap._warnings import warn
from whiskmap._whiskmap import CheckedScene, coordinates

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True)
class RestFit:
    """Curve through the traced points of a resting whisker.

    Attributes
    ----------
    degree : int
        Degree of the curvature as a polynomial of the arclength.
    rms_mm : float
        Root mean square of the distances of the points from the curve, in mm.
    is_degree_chosen : bool
        True if cross-validation chose the degree.
    """

    degree: int
    rms_mm: float
    is_degree_chosen: bool


@dataclass(frozen=True)
class ProfileFit:
    """Polynomial that replaces measured radii.

    Attributes
    ----------
    degree : int
        Degree of the radius as a polynomial of the arclength, which cross-validation chose.
    rms_um : float
        Root mean square of the measured less the smoothed radii, in um.
    """

    degree: int
    rms_um: float


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
    surface : Surface, optional
        A rough surface, for `texture`.
    table : pandas.DataFrame, mapping of columns, or list of mappings, optional
        Whiskers: a `name`, and parameters such as `length_mm`, whose numbers replace those of `whisker`; `profile` and `rest_points` have
        arrays, or None. A name may be a whole number: 1, or the 1.0 of a data frame, is "1". A row with a missing number, NaN, None or NA,
        has no whisker: `refused` has the reason. The table is the first axis of results, `whisker`.

    Raises
    ------
    SceneError
        If a value is out of its range or contradicts another one, or no row of a table has a whisker. `key`, `value` and `allowed` say
        which.
    ValueError
        If columns of a table are not equally long, or arrays of xarray or series of pandas among them have other dimensions or labels.
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
        surface: Surface | None = None,
        table: Any = None,
    ) -> None:
        pole = Pole() if pole is None else pole
        for argument, value, kind in (("whisker", whisker, Whisker), ("grid", grid, Grid), ("pole", pole, Pole)):
            if not isinstance(value, kind):
                raise TypeError(f"{argument} = {value!r}: must be a {kind.__name__}")
        given = {own.name: getattr(whisker, own.name) for own in fields(whisker) if own.name not in (*PAIRS, "profile_smooth", "rest_degree")}
        given |= {"pole_radius_mm": pole.radius_mm or None, "friction": pole.friction or None}
        axes = {"push_angle_deg": grid.push_angle_deg, "distance_mm": grid.distance_mm, **grid.sweep}
        measured, rest = (whisker.profile, whisker.profile_smooth), (whisker.rest_points, whisker.rest_degree)
        self._checked = build(title, given, measured, rest, axes, uncertainty, surface, rows_of(table), name)
        warn(self.warnings)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Scene:
        """Read a scene file (TOML). A CSV file that it names is read beside it.

        Raises
        ------
        OSError
            If the file cannot be read, as where the path is that of a folder.
        SceneError
            If it is no scene.
        """
        return cls._of(CheckedScene.read(os.fspath(path)))._warned()

    @classmethod
    def parse(cls, text: str, name: str = "scene") -> Scene:
        """Check the text of a scene file. `name` is that of the scene if the text gives none."""
        return cls._parsed(text, name)._warned()

    @classmethod
    def _parsed(cls, text: str, name: str) -> Scene:
        return cls._of(CheckedScene.parse(text, f"{name}.toml"))

    @classmethod
    def _of(cls, checked: CheckedScene) -> Scene:
        scene = cls.__new__(cls)
        scene._checked = checked
        return scene

    def _warned(self) -> Scene:
        warn(self.warnings)
        return self

    def replace(self, **changes: Any) -> Scene:
        """Return the scene with other values.

        Parameters
        ----------
        **changes
            A number sets a parameter, such as ``taper=0.5`` or ``pole_radius_mm=1``; it ends a sweep of it. A `Range`, a list or
            an array makes the parameter a sweep axis. None leaves a value out. Also `push_angle_deg`, `distance_mm`, `profile`,
            `profile_smooth`, `rest_points`, `rest_degree`, `yield_strain`, `title`, `name`, `uncertainty`, `surface` and `table`. Their order does not
            matter.

        Raises
        ------
        TypeError
            If a name is unknown, or two names set one number: `taper` and `tip_radius_um`, `parabola_per_mm` and `curvature_per_mm`.
        SceneError
            If a value is out of its range or contradicts another one, or a column of the table gives the number.
        """
        title, given, measured, traced, listed, uncertainty, _, table, name = self._checked.description()
        axes: dict[str, Any] = dict(listed)
        changed: dict[str, Any] = dict(given)
        texts: dict[str, Any] = {"title": title, "name": name, "uncertainty": uncertainty, "surface": self.surface}
        texts["profile"], texts["profile_smooth"] = measured or (None, False)
        texts["rest_points"], texts["rest_degree"] = traced or (None, None)
        texts["table"] = table
        for key in order_of(changes):
            value = changes[key]
            if key in texts:
                texts[key] = value
            elif key in ("push_angle_deg", "distance_mm"):
                axes[key] = axis_of(key, value)
            elif key == "yield_strain":
                changed[key] = None if value is None else number(key, value)
            elif key in PARAMETERS:
                set_parameter(PARAMETERS[key], value, changed, axes)
            else:
                raise TypeError(f"replace() got an unexpected keyword argument {key!r}{resembling(key)}")
        rows, points = (None if texts[own] is None else pairs_of(own, texts[own]) for own in PAIRS)
        is_dropped = points is None and "rest_degree" not in changes
        rest = (points, None if is_dropped else degree_of(texts["rest_degree"]))
        smooth = is_smooth(texts["profile_smooth"]) and (rows is not None or "profile_smooth" in changes)
        rough, whiskers = texts["surface"], rows_of(texts["table"]) if "table" in changes else table
        names = [PARAMETERS.get(key, key) for key in changes if key in PARAMETERS or key == "yield_strain"]
        built = build(texts["title"], changed, (rows, smooth), rest, axes, texts["uncertainty"], rough, whiskers, texts["name"], names)
        return Scene._of(built)._warned()

    @property
    def title(self) -> str:
        """Title, one line of text."""
        return self._checked.description()[0]

    @property
    def name(self) -> str:
        """Stem of the names of files that are written."""
        return self._checked.description()[-1] or ""

    @property
    def whisker(self) -> Whisker:
        """The whisker; a taper is given as the radius at the tip."""
        _, given, measured, traced, *_ = self._checked.description()
        rows, smooth = measured or (None, False)
        points, degree = traced or (None, None)
        own = {name: value for name, value in given.items() if name not in ("pole_radius_mm", "friction")}
        return Whisker(**own, profile=rows, profile_smooth=smooth, rest_points=points, rest_degree=degree)

    @property
    def pole(self) -> Pole:
        """The pole."""
        given = self._checked.description()[1]
        return Pole(radius_mm=given.get("pole_radius_mm", 0.0), friction=given.get("friction", 0.0))

    @property
    def grid(self) -> Grid:
        """The axes as they are given; `coords` has their values."""
        axes = {name: range_of(values) for name, values in self._checked.description()[4]}
        return Grid(push_angle_deg=axes.pop("push_angle_deg"), distance_mm=axes.pop("distance_mm"), sweep=axes)

    @property
    def uncertainty(self) -> dict[str, float] | None:
        """Standard deviations by name, or None."""
        return self._checked.description()[5]

    @property
    def surface(self) -> Surface | None:
        """The rough surface, or None."""
        own = self._checked.description()[6]
        if own is None:
            return None
        *numbers, seed = own
        names = (field.name for field in fields(Surface))
        return Surface(**dict(zip(names, numbers)), seed=seed)

    @property
    def table(self) -> list[dict[str, Any]] | None:
        """Rows of the table of whiskers, or None. A missing number is None."""
        rows = self._checked.description()[7]
        if rows is None:
            return None
        pairs = ([("name", name), *numbers, ("profile", rows), ("rest_points", points)] for name, numbers, rows, points in rows)
        return [{own: None if value != value else value for own, value in row if value is not None} for row in pairs]

    @property
    def refused(self) -> dict[str, str]:
        """Reasons of the rows of the table that have no whisker, by name."""
        return dict(self._checked.refused())

    def select(self, whisker: str | int) -> Scene:
        """Return the scene with one whisker of the table, by its name; a whole number is the name of its digits.

        Raises
        ------
        KeyError
            If there is no such whisker, or its row has none.
        TypeError
            If the name is neither a text nor a number.
        """
        return Scene._of(self._checked.whisker(text_of("whisker", whisker)))

    @property
    def coords(self) -> dict[str, NDArray[Any]]:
        """Values of all axes by name, in the order of a map's dimensions; names of the whiskers of a table."""
        import numpy as np

        return {name: np.asarray(values) for name, _, values in coordinates(self._checked)}

    @property
    def warnings(self) -> list[str]:
        """One line for each number that looks like one in another unit, as a `SceneWarning` has it when the scene is made."""
        return self._checked.warnings()

    @property
    def rest_fit(self) -> RestFit | None:
        """The fit to traced points, or None without such points."""
        own = self._checked.rest_fit()
        return None if own is None else RestFit(*own)

    @property
    def profile_fit(self) -> ProfileFit | None:
        """The polynomial that replaces the measured radii, or None unless they are smoothed."""
        own = self._checked.profile_fit()
        return None if own is None else ProfileFit(*own)

    def to_toml(self) -> str:
        """Return the text of a scene file: the one that was read, or one written from the values."""
        return self._checked.to_toml()

    def __repr__(self) -> str:
        parts = {name: getattr(self, name) for name in ("title", "whisker", "pole", "grid", "name", "uncertainty", "surface", "table")}
        return f"Scene({', '.join(f'{name}={value!r}' for name, value in parts.items() if value is not None)})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._checked == other._checked

    def __hash__(self) -> int:
        return hash((self.title, self.name))

    def __reduce__(self) -> tuple[Any, tuple[str, str]]:
        return (Scene._parsed, (self.to_toml(), self.name))
