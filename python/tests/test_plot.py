"""Plots on matplotlib axes: artists in the colours of the program, with its titles."""

from __future__ import annotations

import matplotlib
import numpy as np
import pytest
from conftest import ROOT, program
from matplotlib.colors import to_hex

import whiskmap as wm
from whiskmap import _whiskmap

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def test_every_plot_returns_artists_of_its_axes(small, cone):
    _, axes = plt.subplots(1, 5)
    ds = wm.map(small)
    mesh = wm.plot.regimes(ds, ax=axes[0])
    colours = {code: colour for code, _, colour, _ in _whiskmap.regimes()}
    drawn = mesh.to_rgba(mesh.get_array()).reshape(-1, 4)
    assert [to_hex(colour) for colour in drawn] == [colours[code] for code in ds.regime.values.ravel()]
    curve = wm.plot.curve(wm.curve(cone), ax=axes[1])
    assert [(line.get_label()[:4], line.get_color()) for line in curve][:1] == [("slip", _whiskmap.inks()["slip-off"])]
    branch = wm.plot.branch(wm.branch(cone, 15.66), ax=axes[2])
    assert [line.get_linestyle() for line in branch] == ["-", "--", "None"]
    # The unstable part begins at the last stable state.
    np.testing.assert_array_equal(branch[0].get_xydata()[-1], branch[1].get_xydata()[0])
    whisker, pole = wm.plot.shape(wm.shape(cone, 15.66, 10), ax=axes[3])
    assert pole.get_radius() == 0.25 and len(whisker.get_xdata()) == 201
    bars = wm.plot.sensitivity(wm.sensitivity(cone, 15.66).sel(side="cb"), ax=axes[4])
    assert len(bars) == 6
    assert all(artist.axes is axis for artist, axis in zip([mesh, curve[0], branch[0], whisker, bars[0]], axes))
    assert wm.plot.curve(wm.curve(cone).sel(side="cb"), linewidth=3)[0].get_linewidth() == 3
    plt.gcf().canvas.draw()


def test_a_single_detachment_is_a_dot(cone):
    """Each curve leaves ink, also that of one point, which a line does not show."""
    for distances, kinds in (([15.0], {"slip-off"}), ([15.0, 16.0, 17.0, 18.0, 19.3], {"slip-off", "pull-off"})):
        ends = wm.curve(cone.replace(distance_mm=distances)).sel(side="cb")
        assert set(ends.kind.values) == kinds
        for kind in kinds:
            figure, axes = plt.subplots()
            wm.plot.curve(ends.where(ends.kind == kind), ax=axes, color="magenta")
            figure.canvas.draw()
            assert (np.asarray(figure.canvas.buffer_rgba())[..., :3] == (255, 0, 255)).all(axis=-1).any(), kind
            plt.close(figure)
    lines = wm.plot.curve(ends, ax=plt.subplots()[1])
    assert [(line.get_marker(), line.get_markevery()) for line in lines] == [("None", None), ("o", [4])]


def test_a_variable_that_no_axis_shows_is_refused(cone):
    whisk = wm.whisk(cone, 15.66, [0, 0.1], [0, 1])
    for draw, own in (
        (lambda name: wm.plot.curve(wm.curve(cone), x=name), "x"),
        (lambda name: wm.plot.branch(wm.branch(cone, 15.66), y=name), "y"),
        (lambda name: wm.plot.whisk(whisk, y=name), "y"),
        (lambda name: wm.plot.force(wm.force(cone, ROOT / "scenes/frames.csv"), y=name), "y"),
    ):
        for name in ("kind", "mark", "reason", "forc_un"):
            with pytest.raises(ValueError, match=f"^{own} = '{name}': must be one of .*force_un"):
                draw(name)


def test_courses_forces_and_fits_are_drawn(cone):
    _, axes = plt.subplots(1, 3)
    time = np.arange(201) / 1000
    found = wm.whisk(cone, 15.66, time, 40 * np.sin(2 * np.pi * 10 * time))
    line, *dots = wm.plot.whisk(found, ax=axes[0])
    np.testing.assert_array_equal(line.get_ydata(), found.samples.force_un)
    assert {dot.get_label() for dot in dots} == set(found.events.event.values)
    assert len(wm.plot.whisk(found, y="arc_length_mm", ax=axes[0])) == 1
    frames = wm.force(cone, ROOT / "scenes/frames.csv", baseline_s=(0, 0.005))
    line, band = wm.plot.force(frames, ax=axes[1], linewidth=3)
    np.testing.assert_array_equal(line.get_ydata(), frames.force_un)
    assert line.get_linewidth() == 3 and band.axes is axes[1]
    fit = wm.fit(cone, ROOT / "scenes/cone_points.csv", ["tip_radius_um", "parabola_per_mm"])
    artists = wm.plot.fit(fit, ax=axes[2])
    drawn = sum(len(artist.get_xdata()) for artist in artists if artist.get_linestyle() == "None")
    assert drawn == fit.points.sizes["point"] and axes[2].get_ylabel() == wm.plot.DISTANCE
    plt.gcf().canvas.draw()


def test_names_of_variables_fit_on_an_axis(small, cone):
    time = np.arange(101) / 1000
    whisk = wm.whisk(cone, 15.66, time, 40 * np.sin(2 * np.pi * 10 * time))
    datasets = [
        wm.map(small), wm.curve(cone), wm.branch(cone, 15.66), wm.shape(cone, 15.66, 10), whisk.samples, whisk.events,
        wm.force(cone, ROOT / "scenes/frames.csv"), wm.locate(cone, {"base_moment_nnm": [60], "base_force_y_un": [6]}),
    ]
    for ds in datasets:
        for name, variable in ds.variables.items():
            words = variable.attrs.get("long_name", "").split()
            assert len(words) <= 6, (name, words)
    assert whisk.samples.base_moment_nnm.attrs["long_name"] == "base moment"
    assert whisk.samples.base_moment_nnm.attrs["comment"].startswith("Moment of the pole on the base")


def test_a_branch_of_both_sides_has_each_name_once(cone):
    _, axes = plt.subplots()
    artists = wm.plot.branch(wm.branch(cone, 15.66, "both"), ax=axes)
    assert [line.get_linestyle() for line in artists] == ["-", "--", "-", "--", "None", "None"]
    assert axes.get_legend_handles_labels()[1] == ["stable", "unstable", "slip-off"]


def test_the_distance_grows_upward(small, cone):
    for draw, ds in ((wm.plot.regimes, wm.map(small)), (wm.plot.curve, wm.curve(cone))):
        _, axes = plt.subplots()
        draw(ds, ax=axes)
        low, high = axes.get_ylim()
        assert low < high


@pytest.mark.parametrize("size", [(3.3, 3.0), (6.4, 4.8), (12.0, 4.0)])
def test_the_legend_hides_no_cells(small, size):
    figure, axes = plt.subplots(figsize=size)
    ds = wm.map(small)
    wm.plot.regimes(ds, ax=axes)
    figure.canvas.draw()
    [legend] = [child for child in axes.get_children() if isinstance(child, matplotlib.legend.Legend)]
    box, inside = legend.get_window_extent(), axes.get_window_extent()
    assert not box.overlaps(inside) and box.width <= inside.width
    # It lies in the figure, clear of the title of the axis.
    assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1
    title = axes.xaxis.label.get_window_extent()
    assert box.y1 <= title.y0
    present = {name for code, name, *_ in _whiskmap.regimes() if code in ds.regime.values}
    assert {text.get_text() for text in legend.get_texts()} == present


def test_legends_of_parts_of_a_figure_lie_in_it(small):
    figure = plt.figure(figsize=(8, 4))
    for part in figure.subfigures(1, 2):
        wm.plot.regimes(wm.map(small), ax=part.subplots())
    figure.canvas.draw()
    boxes = [part.axes[0].get_legend().get_window_extent() for part in figure.subfigs]
    assert len(boxes) == 2 and all(box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1 for box in boxes)


def test_regimes_can_be_those_of_the_variable(small):
    _, axes = plt.subplots()
    ds = wm.map(small)
    mesh = wm.plot.regimes(ds.regime.expand_dims("taper"), ax=axes)
    np.testing.assert_array_equal(mesh.get_array(), ds.regime)


@pytest.mark.parametrize(
    ("message", "draw"),
    [
        (r"has 2 values of side, .*by ds.sel\(side='cf'\)", lambda s: wm.plot.sensitivity(wm.sensitivity(s, distance_mm=10))),
        ("has .*2 values of side.*, must have one", lambda s: wm.plot.sensitivity(wm.sensitivity(s))),
        (r"has 2 values of taper, must have one: select one, as by ds.sel\(taper=0.5\)", lambda s: wm.plot.curve(wm.curve(s.replace(taper=[0.5, 1])))),
        (r"has 2 values of taper, must have one", lambda s: wm.plot.regimes(wm.map(s.replace(taper=[0.5, 1])))),
        (r"has 2 values of taper, must have one", lambda s: wm.plot.regimes(wm.map(s.replace(taper=[0.5, 1])).regime)),
        ("must have the axes distance_mm and push_angle_deg, has push_angle_deg", lambda s: wm.plot.regimes(wm.map(s).isel(distance_mm=0))),
        ("must be a dataset of map or open, has no variable regime", lambda s: wm.plot.regimes(wm.map(s).force_un)),
        ("must be a dataset of curve, has no variable kind", lambda s: wm.plot.curve(wm.map(s))),
        ("must be a dataset of sensitivity, has no variable d_push_angle_deg", lambda s: wm.plot.sensitivity(wm.curve(s))),
    ],
)
def test_data_that_no_plot_fits_are_refused(small, message, draw):
    with pytest.raises(ValueError, match=f"^ds: {message}"):
        draw(small)


def test_sweeps_of_one_value_are_drawn(small):
    _, axes = plt.subplots()
    one = small.replace(taper=[0.95])
    assert len(wm.plot.regimes(wm.map(one), ax=axes).get_array()) == 16
    assert wm.plot.curve(wm.curve(one), ax=axes)


def test_regimes_without_a_cell_have_no_entry(small):
    figure, axes = plt.subplots()
    wm.plot.regimes(wm.map(small).isel(distance_mm=slice(0, 2), push_angle_deg=slice(10, 14)), ax=axes)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["contact"]
    assert len(figure.legends) == 0


def test_titles_of_axes_are_those_of_the_program(small, cone, tmp_path):
    path = ROOT / "scenes/cone.toml"
    cases = {
        "curve": (wm.plot.curve, wm.curve(small), {}, ("curve", path, "--csv", tmp_path / "curve.csv")),
        "force": (wm.plot.curve, wm.curve(small), {"x": "force_un"}, None),
        "branch": (wm.plot.branch, wm.branch(cone, 15.66), {}, ("branch", path, "--distance", 15.66, "--csv", tmp_path / "branch.csv")),
    }
    for column in ("force_un", "base_moment_nnm", "contact_angle_deg"):
        arguments = ("branch", path, "--distance", 15.66, "--y", column, "--csv", tmp_path / f"{column}.csv")
        cases[column] = (wm.plot.branch, wm.branch(cone, 15.66), {"y": column}, arguments)
    for name, (draw, ds, options, arguments) in cases.items():
        _, axes = plt.subplots()
        draw(ds, ax=axes, **options)
        if arguments is None:
            assert axes.get_xlabel() == "contact force at detachment (\u00b5N)"
            continue
        picture = tmp_path / f"{name}.svg"
        program(*arguments, "--plot", picture)
        svg = picture.read_text()
        for title in (axes.get_xlabel(), axes.get_ylabel()):
            assert f">{title}<" in svg, title
    _, axes = plt.subplots()
    wm.plot.regimes(wm.map(small), ax=axes)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("push angle (deg)", "distance at first touch (mm)")
