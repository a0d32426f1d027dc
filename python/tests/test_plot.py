"""Plots on matplotlib axes: artists in the colours of the program."""

from __future__ import annotations

import matplotlib
import numpy as np
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
    assert [to_hex(own) for own in drawn] == [colours[code] for code in ds.regime.values.ravel()]
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
    assert all(own.axes is axis for own, axis in zip([mesh, curve[0], branch[0], whisker, bars[0]], axes))
    assert wm.plot.curve(wm.curve(cone).sel(side="cb"), linewidth=3)[0].get_linewidth() == 3
    plt.gcf().canvas.draw()
