"""Maps, curves, branches and shapes on matplotlib axes, in the colours of the program."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from whiskmap._warnings import require
from whiskmap._whiskmap import axis_title, inks
from whiskmap._whiskmap import regimes as _regimes

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.container import BarContainer
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

require("matplotlib", "plot")

PUSH_ANGLE = axis_title("push_angle_deg", False)
DISTANCE = axis_title("distance_mm", False)

# Axes narrower than this, in inches, have no room for a legend.
_NARROW = 4.0


def regimes(ds: xr.Dataset, *, ax: Axes | None = None, legend: bool = True) -> QuadMesh:
    """Draw the regimes of one whisker over push angle and distance.

    Parameters
    ----------
    ds : xarray.Dataset
        A dataset of `map` or `open`. Of a sweep, one whisker is selected before: ``ds.sel(taper=0.5)``.
    ax : matplotlib.axes.Axes, optional
        The current axes if left out.
    legend : bool
        False draws no legend. It names the regimes of the cells; below narrow axes, otherwise inside.

    Returns
    -------
    matplotlib.collections.QuadMesh
    """
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    axes = _axes(ax)
    regime = ds["regime"].transpose("distance_mm", "push_angle_deg")
    known = _regimes()
    codes = [code for code, *_ in known]
    colours = [colour for _, _, colour, _ in known]
    norm = BoundaryNorm([-0.5, *(code + 0.5 for code in codes)], len(codes))
    mesh = axes.pcolormesh(ds["push_angle_deg"], ds["distance_mm"], regime, cmap=ListedColormap(colours), norm=norm)
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
        Properties of the lines.

    Returns
    -------
    list of matplotlib.lines.Line2D
    """
    axes = _axes(ax)
    colours, lines, named = inks(), [], set()
    for side in np.atleast_1d(ds["side"].values):
        own = ds.sel(side=side) if "side" in ds.dims else ds
        for kind in ("slip-off", "pull-off"):
            values = own[x].where(own["kind"] == kind)
            if values.notnull().any():
                label = None if kind in named else kind
                named.add(kind)
                lines += axes.plot(values, own["distance_mm"], **{"color": colours[kind], "label": label} | line)
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
    """
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

    axes = _axes(ax)
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
    """
    axes = _axes(ax)
    change = (ds["d_push_angle_deg"] * ds["value"] / 100).squeeze()
    change = change[(change.notnull() & (change != 0)).values][::-1]
    drawn = axes.barh(list(change["variable"].values), change.values, **{"color": inks()["pull-off"]} | bars)
    axes.set(xlabel=axis_title("push_of_1_percent_deg", False))
    return drawn


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.gca()


def _legend(axes: Axes, handles: list[Patch]) -> None:
    from matplotlib.figure import Figure

    figure = axes.figure
    if axes.get_window_extent().width / figure.dpi >= _NARROW:
        axes.legend(handles=handles, loc="best", fontsize="small")
        return
    # A layout that makes room below the axes, unless the figure has one.
    if isinstance(figure, Figure) and figure.get_layout_engine() is None:
        figure.set_layout_engine("constrained")
    # The pad is that of ticks, numbers and title of the axis, in sizes of the font.
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), borderaxespad=5.0, fontsize="x-small")
