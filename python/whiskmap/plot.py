"""Maps, curves, branches, shapes, courses, forces and fits on matplotlib axes, in the colours of the program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import xarray as xr

from whiskmap._warnings import require
from whiskmap._whiskmap import axis_title, inks
from whiskmap._whiskmap import regimes as _regimes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.container import BarContainer
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from numpy.typing import NDArray

    from whiskmap._fits import Fit
    from whiskmap._motion import Whisk

require("matplotlib", "plot")

PUSH_ANGLE = axis_title("push_angle_deg", False)
DISTANCE = axis_title("distance_mm", False)

_Data = TypeVar("_Data", xr.Dataset, xr.DataArray)

# Axes narrower than this, in inches, have a legend in small print.
_NARROW = 4.0


def regimes(ds: xr.Dataset | xr.DataArray, *, ax: Axes | None = None, legend: bool = True) -> QuadMesh:
    """Draw the regimes of one whisker over push angle and distance.

    Parameters
    ----------
    ds : xarray.Dataset or xarray.DataArray
        A dataset of `map` or `open`, or its variable `regime`. Of a sweep, one whisker is selected before: ``ds.sel(taper=0.5)``.
    ax : matplotlib.axes.Axes, optional
        The current axes if left out.
    legend : bool
        False draws no legend. It names the regimes of the cells, and lies below the axes. A figure without a layout engine gets the
        layout "constrained", which makes room for it.

    Returns
    -------
    matplotlib.collections.QuadMesh

    Raises
    ------
    ValueError
        If there are no regimes, or those of several whiskers.
    """
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    found = ds if isinstance(ds, xr.DataArray) and ds.name == "regime" else _of(ds, "map or open", "regime")["regime"]
    regime = _single(found, ("distance_mm", "push_angle_deg"))
    if regime.ndim != 2:
        raise ValueError(f"ds: must have the axes distance_mm and push_angle_deg, has {' and '.join(map(str, regime.dims)) or 'none'}")
    regime = regime.transpose("distance_mm", "push_angle_deg")
    axes = _axes(ax)
    known = _regimes()
    codes = [code for code, *_ in known]
    colours = [colour for _, _, colour, _ in known]
    norm = BoundaryNorm([-0.5, *(code + 0.5 for code in codes)], len(codes))
    mesh = axes.pcolormesh(regime["push_angle_deg"], regime["distance_mm"], regime, cmap=ListedColormap(colours), norm=norm)
    axes.set(xlabel=PUSH_ANGLE, ylabel=DISTANCE)
    if legend:
        present = np.unique(regime)
        _legend(axes, [Patch(color=colour, label=name) for code, name, colour, _ in known if code in present])
    return mesh


def curve(ds: xr.Dataset, *, x: str = "push_angle_deg", ax: Axes | None = None, **line: Any) -> list[Line2D]:
    """Draw the detachment curves of one whisker: slip-off black, pull-off blue.

    Parameters
    ----------
    ds : xarray.Dataset
        A dataset of `curve`. Of a sweep, one whisker is selected before.
    x : str
        Variable along the horizontal axis; the vertical axis is the distance.
    ax : matplotlib.axes.Axes, optional
    **line
        Properties of the lines. A detachment without a neighbour of its kind is a dot.

    Returns
    -------
    list of matplotlib.lines.Line2D

    Raises
    ------
    ValueError
        If the dataset is not one of `curve`, or has several whiskers, or `x` is no variable of numbers.
    """
    ds = _single(_of(ds, "curve", "kind"), ("side", "distance_mm"))
    _check_quantity(ds, "x", x)
    axes = _axes(ax)
    colours, lines, named = inks(), [], set()
    for side in np.atleast_1d(ds["side"].values):
        own = ds.sel(side=side) if "side" in ds.dims else ds
        for kind in ("slip-off", "pull-off"):
            values = own[x].where(own["kind"] == kind)
            if values.notnull().any():
                look = {"color": colours[kind], "label": None if kind in named else kind, **_dots(values.values)}
                named.add(kind)
                lines += axes.plot(values, own["distance_mm"], **look | line)
    axes.set(xlabel=axis_title(x, True), ylabel=DISTANCE)
    return lines


def branch(ds: xr.Dataset, *, y: str = "arc_length_mm", ax: Axes | None = None, **line: Any) -> list[Artist]:
    """Draw a branch: solid where it is stable, dashed beyond the fold, with dots at the ends of the stable states.

    Parameters
    ----------
    ds : xarray.Dataset
        A dataset of `branch`, of one side or both.
    y : str
        Variable along the vertical axis.
    ax : matplotlib.axes.Axes, optional
    **line
        Properties of the lines.

    Returns
    -------
    list of matplotlib.artist.Artist
        The lines, then the dots.

    Raises
    ------
    ValueError
        If `y` is no variable of numbers.
    """
    _check_quantity(ds, "y", y)
    axes = _axes(ax)
    colours = inks()
    artists: list[Artist] = []
    named: set[str] = set()

    def draw(own: xr.Dataset, stroke: str, name: str, colour: str) -> None:
        look = {"color": colours[colour], "label": None if name in named else name}
        named.add(name)
        artists.extend(axes.plot(own["push_angle_deg"], own[y], stroke, **look | (line if stroke != "o" else {})))

    branches = [ds.isel(side=index) for index in range(ds.sizes["side"])] if "side" in ds.dims else [ds]
    for one in branches:
        stable = one["stable"].values
        # The last stable state also begins the unstable part.
        for chosen, stroke, name in [(stable, "-", "stable"), (~stable | np.append(~stable[1:], False), "--", "unstable")]:
            if chosen.any():
                draw(one.isel(point=chosen), stroke, name, "slip-off")
    for one in branches:
        for mark in ("slip-off", "pull-off"):
            own = one.isel(point=one["mark"].values == mark)
            if own.sizes["point"]:
                draw(own, "o", mark, mark)
    axes.set(xlabel=PUSH_ANGLE, ylabel=axis_title(y, False))
    return artists


def shape(ds: xr.Dataset, *, ax: Axes | None = None, **line: Any) -> list[Artist]:
    """Draw the shape of a whisker and its pole.

    Parameters
    ----------
    ds : xarray.Dataset
        A dataset of `shape`.
    ax : matplotlib.axes.Axes, optional
    **line
        Properties of the line.

    Returns
    -------
    list of matplotlib.artist.Artist
        The line of the whisker, and the pole.
    """
    from matplotlib.patches import Circle

    axes, ds = _axes(ax), _of(ds, "shape", "x_mm")
    [whisker] = axes.plot(ds["x_mm"], ds["y_mm"], **{"color": inks()["slip-off"]} | line)
    centre = (ds.attrs["pole_x_mm"], ds.attrs["pole_y_mm"])
    pole = axes.add_patch(Circle(centre, ds.attrs["pole_radius_mm"], color=inks()["background"]))
    axes.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
    return [whisker, pole]


def sensitivity(ds: xr.Dataset, *, ax: Axes | None = None, **bars: Any) -> BarContainer:
    """Draw by how much the push angle at detachment changes for 1 % of each variable.

    Parameters
    ----------
    ds : xarray.Dataset
        A dataset of `sensitivity` at one distance and side: ``ds.sel(side="cb", distance_mm=15.66)``.
    ax : matplotlib.axes.Axes, optional
    **bars
        Properties of the bars.

    Returns
    -------
    matplotlib.container.BarContainer
        A bar for each variable with a value that is not 0.

    Raises
    ------
    ValueError
        If the dataset is not one of `sensitivity`, or has several distances or sides.
    """
    own = _single(_of(ds, "sensitivity", "d_push_angle_deg"), ("variable",))
    axes = _axes(ax)
    change = own["d_push_angle_deg"] * own["value"] / 100
    change = change[(change.notnull() & (change != 0)).values][::-1]
    drawn = axes.barh(list(change["variable"].values), change.values, **{"color": inks()["pull-off"]} | bars)
    axes.set(xlabel=axis_title("push_of_1_percent_deg", False))
    return drawn


def whisk(found: Whisk, *, y: str = "force_un", ax: Axes | None = None, **line: Any) -> list[Artist]:
    """Draw a quantity of a course over time, with a dot at each event that has the quantity.

    Parameters
    ----------
    found : Whisk
        A result of `whisk`.
    y : str
        Variable of the samples along the vertical axis. Lines break where the state is undecided.
    ax : matplotlib.axes.Axes, optional
    **line
        Properties of the line.

    Returns
    -------
    list of matplotlib.artist.Artist
        The line, then the dots: touches open, slip-offs black, pull-offs blue, others grey.

    Raises
    ------
    ValueError
        If `y` is no variable of numbers.
    """
    _check_quantity(found.samples, "y", y)
    axes, colours = _axes(ax), inks()
    samples, events = found.samples, found.events
    artists: list[Artist] = list(axes.plot(samples["time_s"], samples[y], **{"color": colours["slip-off"]} | line))
    for kind in np.unique(events["event"].values) if y in events else ():
        own = events.isel(number=events["event"].values == kind)
        colour = colours[kind] if kind in ("slip-off", "pull-off") else "grey"
        face = "none" if kind == "touch" else colour
        artists += axes.plot(own["time_s"], own[y], "o", color=colour, markerfacecolor=face, label=str(kind))
    axes.set(xlabel=axis_title("time_s", False), ylabel=axis_title(y, False))
    return artists


def force(ds: xr.Dataset, *, y: str = "force_un", ax: Axes | None = None, **line: Any) -> list[Artist]:
    """Draw a quantity of forces in frames over time, with a band of one standard deviation if there is one.

    Parameters
    ----------
    ds : xarray.Dataset
        A dataset of `force`.
    y : str
        Variable along the vertical axis, such as "force_un", "base_force_x_un", "base_force_y_un" or "base_moment_nnm".
    ax : matplotlib.axes.Axes, optional
    **line
        Properties of the line, which breaks where a frame has no force.

    Returns
    -------
    list of matplotlib.artist.Artist
        The line, then the band.

    Raises
    ------
    ValueError
        If `y` is no variable of numbers.
    """
    _check_quantity(ds, "y", y)
    axes, colour = _axes(ax), inks()["slip-off"]
    artists: list[Artist] = list(axes.plot(ds["time_s"], ds[y], **{"color": colour} | line))
    stem, unit = y.rsplit("_", 1)
    deviation = f"{stem}_sd_{unit}"
    if deviation in ds and ds[deviation].notnull().any():
        low, high = ds[y] - ds[deviation], ds[y] + ds[deviation]
        artists.append(axes.fill_between(ds["time_s"].values, low.values, high.values, color=colour, alpha=0.2, linewidth=0))
    axes.set(xlabel=axis_title("time_s", False), ylabel=axis_title(y, False))
    return artists


def fit(found: Fit, *, ax: Axes | None = None, **line: Any) -> list[Artist]:
    """Draw measured points with their standard deviations, and the detachment curve of the fitted scene.

    Parameters
    ----------
    found : Fit
        A result of `fit` to push angles or chord angles.
    ax : matplotlib.axes.Axes, optional
    **line
        Properties of the lines of the curve.

    Returns
    -------
    list of matplotlib.artist.Artist
        The lines of the curve, then the points: slip-offs and points of unknown kind open, pull-offs filled.
    """
    from whiskmap._fits import Fit
    from whiskmap._traces import curve as computed

    if not isinstance(found, Fit):
        raise TypeError(f"found: must be a result of fit, has the type {type(found).__name__}")
    axes, points = _axes(ax), found.points
    x = "push_chord_deg" if found.is_chord else "push_angle_deg"
    distances = points["distance_mm"].values
    least, most = np.nanmin(distances), np.nanmax(distances)
    scene = found.scene.replace(distance_mm=np.unique(np.append(np.linspace(least, most, 200), distances[~np.isnan(distances)])))
    artists: list[Artist] = list(curve(computed(scene), x=x, ax=axes, **line))
    for is_pull_off in (False, True):
        own = points.isel(point=(points["kind"].values == "pull-off") == is_pull_off)
        if not own.sizes["point"]:
            continue
        deviation = own["sd_deg"].values
        bars = None if np.isnan(deviation).all() else deviation
        colour = inks()["pull-off" if is_pull_off else "slip-off"]
        face, label = (colour, "measured pull-off") if is_pull_off else ("none", "measured")
        drawn = axes.errorbar(
            own["measured_deg"], own["distance_mm"], xerr=bars, label=label, color=colour, markerfacecolor=face, linestyle="none", marker="o"
        )
        artists += [drawn.lines[0]]
    return artists


def _of(ds: Any, source: str, variable: str) -> xr.Dataset:
    """Return the dataset; other data, or a dataset without this variable of the results of `source`, are refused."""
    if not isinstance(ds, xr.Dataset) or variable not in ds:
        raise ValueError(f"ds: must be a dataset of {source}, has no variable {variable}")
    return ds


def _single(data: _Data, kept: Sequence[str]) -> _Data:
    """Return the data without axes of one value; several values on an axis that is not in `kept` are refused."""
    several = [name for name in data.dims if name not in kept and data.sizes[name] != 1]
    if several:
        counts = " and ".join(f"{data.sizes[name]} values of {name}" for name in several)
        chosen = ", ".join(f"{name}={data[name].values[:1].tolist()[0]!r}" for name in several if data.sizes[name])
        raise ValueError(f"ds: has {counts}, must have one: select one, as by ds.sel({chosen})")
    return data.squeeze([name for name in data.dims if name not in kept])


def _check_quantity(ds: xr.Dataset, argument: str, name: str) -> None:
    """Refuse a name, the value of `argument`, that is no variable of numbers."""
    names = [str(own) for own, values in ds.data_vars.items() if values.dtype.kind == "f"]
    if name not in names:
        raise ValueError(f"{argument} = {name!r}: must be one of {', '.join(names)}")


def _dots(values: NDArray[Any]) -> dict[str, Any]:
    """Return the properties of a line that shows numbers between NaNs, of which a line without markers shows nothing, as dots."""
    is_known = np.pad(np.atleast_1d(~np.isnan(values)), 1)
    is_alone = is_known[1:-1] & ~is_known[:-2] & ~is_known[2:]
    return {"marker": "o", "markevery": np.flatnonzero(is_alone).tolist()} if is_alone.any() else {}


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.gca()


def _legend(axes: Axes, handles: list[Patch]) -> None:
    figure = axes.figure.canvas.figure
    # A layout that makes room below the axes, unless the figure has one.
    if figure.get_layout_engine() is None:
        figure.set_layout_engine("constrained")
    width = axes.get_window_extent().width
    size = "small" if width / figure.dpi >= _NARROW else "x-small"
    # As many columns as the axes have room for.
    for columns in range(len(handles), 0, -1):
        # The pad is that of ticks, numbers and title of the axis, in sizes of the font.
        legend = axes.legend(
            handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), borderaxespad=5.0, fontsize=size, ncols=columns
        )
        if legend.get_window_extent().width <= width:
            break
