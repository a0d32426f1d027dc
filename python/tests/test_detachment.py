"""Detachments of arrays: shapes, agreement with curves, Jacobians, and fits by scipy."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from conftest import ROOT
from scipy.optimize import least_squares

import whiskmap as wm

CONE = dict(length_mm=20.0, base_radius_um=30.0, tip_radius_um=1.5, youngs_modulus_gpa=3.0, parabola_per_mm=0.02, pole_radius_mm=0.25)


def test_arguments_broadcast(cone):
    assert wm.detachment(cone, distance_mm=15.66).push_angle_deg.shape == (2,)
    assert wm.detachment(cone, distance_mm=15.66, side="cf").push_angle_deg.shape == ()
    tapers = np.array([[0.5], [0.9]])
    end = wm.detachment(cone, distance_mm=[12, 15, 25], taper=tapers, side="both", jac=True)
    assert end.kind.shape == (2, 3, 2) and end.jac["force_un"].shape == (2, 3, 2, 1) and end.variables == ("taper",)
    assert (end.kind[:, 2] == "out-of-reach").all() and np.isnan(end.jac["push_angle_deg"][:, 2]).all()
    sides = wm.detachment(cone, distance_mm=[15, 15, 12], taper=tapers, side=["cb", "cf", "cb"])
    # Other distances on a sheet change the last digits.
    np.testing.assert_allclose(sides.push_angle_deg, end.push_angle_deg[:, [1, 1, 0], [1, 0, 1]], rtol=1e-12)
    assert wm.detachment(cone, distance_mm=np.zeros((0, 3))).kind.shape == (0, 3, 2)
    # An array of one value has one dimension.
    assert wm.detachment(cone, distance_mm=[15.0], taper=[0.5], side="cb").kind.shape == (1,)


def test_elements_with_nan_are_no_whisker_however_many(cone):
    for arguments in (dict(distance_mm=[np.nan]), dict(distance_mm=np.nan), dict(distance_mm=15, taper=[np.nan]), dict(distance_mm=[np.nan] * 2)):
        end = wm.detachment(cone, side="cb", jac=True, **arguments)
        assert np.all(end.kind == "no-whisker") and np.isnan(end.push_angle_deg).all()
        assert len(end.refused) == end.kind.size and set(end.refused.values()) <= {"distance_mm is missing", "taper is missing"}
        with pytest.raises(ValueError, match="must be finite"):
            wm.detachment(cone, side="cb", strict=True, **arguments)


def test_labels_must_match_place_by_place(cone):
    distances = xr.DataArray([15.0, 16.0], dims="distance")
    with pytest.raises(ValueError, match="taper: has the dimension taper where distance_mm has distance"):
        wm.detachment(cone, distance_mm=distances, taper=xr.DataArray([0.5, 0.6], dims="taper"), side="cb")
    series = pd.Series([15.0, 16.0], index=["C1", "C2"])
    with pytest.raises(ValueError, match="taper: has other labels than distance_mm"):
        wm.detachment(cone, distance_mm=series, taper=pd.Series([0.6, 0.5], index=["C2", "C1"]), side="cb")
    matching = wm.detachment(cone, distance_mm=series, taper=pd.Series([0.5, 0.6], index=["C1", "C2"]), side="cb")
    plain = wm.detachment(cone, distance_mm=[15.0, 16.0], taper=[0.5, 0.6], side="cb")
    np.testing.assert_array_equal(matching.push_angle_deg, plain.push_angle_deg)


def labelled(values, labels=None, dimension="whisker"):
    return xr.DataArray(values, dims=dimension, coords=None if labels is None else {dimension: labels})


@pytest.mark.parametrize("distances", [[12.0, 13.0], labelled([12.0, 13.0]), pd.Index([12.0, 13.0])], ids=["list", "xarray", "index"])
def test_labels_are_compared_where_the_first_argument_has_none(cone, distances):
    others = dict(taper=labelled([0.5, 0.6], ["a", "b"]), parabola_per_mm=labelled([0.02, 0.0], ["b", "a"]))
    with pytest.raises(ValueError, match="^parabola_per_mm: has other labels than taper: arrays are combined by place"):
        wm.detachment(cone, distance_mm=distances, side="cb", **others)
    others["parabola_per_mm"] = labelled([0.0, 0.02], ["a", "b"])
    plain = wm.detachment(cone, distance_mm=[12.0, 13.0], side="cb", taper=[0.5, 0.6], parabola_per_mm=[0.0, 0.02])
    np.testing.assert_array_equal(wm.detachment(cone, distance_mm=distances, side="cb", **others).push_angle_deg, plain.push_angle_deg)


@pytest.mark.parametrize("distances", [[12.0, 13.0], pd.Series([12.0, 13.0]), pd.Index([12.0, 13.0])], ids=["list", "series", "index"])
def test_dimensions_are_compared_where_the_first_argument_has_none(cone, distances):
    others = dict(taper=labelled([0.5, 0.6]), parabola_per_mm=labelled([0.02, 0.0], dimension="curve"))
    with pytest.raises(ValueError, match="^parabola_per_mm: has the dimension curve where taper has whisker"):
        wm.detachment(cone, distance_mm=distances, side="cb", **others)


def test_data_frames_have_labels_along_both_axes(cone):
    distances = pd.DataFrame([[12.0, 13.0], [14.0, 15.0]], index=["a", "b"], columns=["x", "y"])
    tapers = distances / 20
    plain = wm.detachment(cone, distance_mm=distances.to_numpy(), taper=tapers.to_numpy(), side="cb")
    np.testing.assert_array_equal(wm.detachment(cone, distance_mm=distances, taper=tapers, side="cb").push_angle_deg, plain.push_angle_deg)
    rows = pd.Series([0.5, 0.9], index=["a", "b"])
    for other in (tapers.set_axis(["y", "x"], axis="columns"), tapers.set_axis(["b", "a"], axis="index"), rows, labelled([0.5, 0.9], ["a", "b"])):
        with pytest.raises(ValueError, match="^taper: has other labels than distance_mm"):
            wm.detachment(cone, distance_mm=distances, taper=other, side="cb")
    # A series or an array of one dimension is broadcast along the columns.
    columns = rows.set_axis(["x", "y"])
    plain = wm.detachment(cone, distance_mm=distances.to_numpy(), taper=[0.5, 0.9], side="cb")
    for other in (columns, labelled([0.5, 0.9], ["x", "y"])):
        np.testing.assert_array_equal(wm.detachment(cone, distance_mm=distances, taper=other, side="cb").push_angle_deg, plain.push_angle_deg)


def test_an_index_of_pandas_is_plain_values(cone):
    found = wm.detachment(cone, distance_mm=pd.Index([12.0, 15.0]), side=pd.Index(["cb", "cf"]), taper=pd.Series([0.5, 0.9], index=["a", "b"]))
    plain = wm.detachment(cone, distance_mm=[12.0, 15.0], side=["cb", "cf"], taper=[0.5, 0.9])
    np.testing.assert_array_equal(found.push_angle_deg, plain.push_angle_deg)


def test_rows_of_any_order_are_those_of_the_curve(cone):
    rng = np.random.default_rng(1)
    distances = rng.permutation(np.repeat(np.linspace(5, 19, 20), 2))
    tapers = rng.choice([0.5, 0.9, 0.95], distances.size)
    end = wm.detachment(cone, distance_mm=distances, taper=tapers)
    for taper in np.unique(tapers):
        chosen = tapers == taper
        curve = wm.curve(cone.replace(taper=taper, distance_mm=np.unique(distances[chosen])))
        for name in ("push_angle_deg", "force_un", "base_moment_nnm", "energy_nj"):
            expected = curve[name].sel(distance_mm=distances[chosen]).transpose("distance_mm", "side")
            np.testing.assert_allclose(getattr(end, name)[chosen], expected, rtol=1e-9)
    threads = wm.detachment(cone, distance_mm=distances, taper=tapers, threads=1)
    np.testing.assert_array_equal(threads.force_un, end.force_un)


@pytest.mark.parametrize("given", [{}, {"taper": 0.9}], ids=["tip", "taper"])
def test_jacobians_are_those_of_the_arguments(given):
    numbers = CONE | given
    if given:
        del numbers["tip_radius_um"]
    numbers |= {"distance_mm": 15.0}
    names = tuple(numbers)
    ends = wm.detachment(side="cb", jac=names, **numbers)
    for place, name in enumerate(names):
        step = 1e-5 * numbers[name]
        low, high = (wm.detachment(side="cb", **numbers | {name: numbers[name] + sign * step}) for sign in (-1, 1))
        for quantity in ("push_angle_deg", "push_chord_deg", "force_un", "arc_length_mm", "base_moment_nnm"):
            difference = (getattr(high, quantity) - getattr(low, quantity)) / (2 * step)
            jacobian = ends.jac[quantity][place]
            assert jacobian == pytest.approx(difference, rel=1e-6, abs=1e-7), (name, quantity)


def test_least_squares_of_scipy_finds_the_whisker(cone):
    points = pd.read_csv(ROOT / "scenes/cone_points.csv", comment="#")

    def end(x):
        return wm.detachment(
            cone, distance_mm=points.distance_mm, side=points.side, tip_radius_um=x[0], parabola_per_mm=x[1], jac=True
        )

    found = least_squares(
        lambda x: (end(x).push_angle_deg - points.push_angle_deg) / points.sd_deg,
        [1.5, 0.02],
        jac=lambda x: end(x).jac["push_angle_deg"] / points.sd_deg.to_numpy()[:, None],
        x_scale=[1, 0.01],
    )
    fit = wm.fit(cone, points, ["tip_radius_um", "parabola_per_mm"])
    np.testing.assert_allclose(found.x, fit.estimates.value, rtol=1e-4)
    assert 2 * found.cost == pytest.approx(fit.chi_square, rel=1e-6)


def test_masked_values_are_refused_in_every_argument(cone):
    sides, numbers = np.ma.array(["cb", "cf"], mask=[False, True]), np.ma.array([0.5, 0.9], mask=[False, True])
    for side in (sides, sides.astype(object), [sides], ["cb", np.ma.masked], np.ma.array("cb", mask=True), np.ma.masked):
        with pytest.raises(ValueError, match="^side: has masked values; leave them out"):
            wm.detachment(cone, distance_mm=[12.0, 15.0], side=side)
    for taper in (numbers, [numbers], [0.5, np.ma.masked], np.ma.masked):
        with pytest.raises(ValueError, match="^taper: has masked values; leave them out"):
            wm.detachment(cone, distance_mm=[12.0, 15.0], taper=taper)
    sides.mask = False
    wanted = wm.detachment(cone, distance_mm=[12.0, 15.0], side=["cb", "cf"])
    np.testing.assert_array_equal(wm.detachment(cone, distance_mm=[12.0, 15.0], side=sides).push_angle_deg, wanted.push_angle_deg)


def test_sides_may_be_in_capitals(cone):
    wanted = wm.detachment(cone, distance_mm=[12.0, 15.0], side=["cb", "cf"])
    for side in (["CB", "Cf"], np.array(["CB", "CF"]), np.array(["cB", "cf"], dtype=object)):
        np.testing.assert_array_equal(wm.detachment(cone, distance_mm=[12.0, 15.0], side=side).push_angle_deg, wanted.push_angle_deg)
    both = wm.detachment(cone, distance_mm=[12.0, 15.0], side="BOTH")
    np.testing.assert_array_equal(both.push_angle_deg, wm.detachment(cone, distance_mm=[12.0, 15.0]).push_angle_deg)


def test_a_pole_that_reaches_the_base_refuses_its_distance_alone():
    cone = dict(length_mm=20.0, base_radius_um=30.0, youngs_modulus_gpa=3.0, taper=0.95, side="cb")
    near = wm.detachment(pole_radius_mm=[[0.25], [0.1]], distance_mm=[0.2, 12.0], **cone)
    alone = wm.detachment(pole_radius_mm=0.25, distance_mm=[12.0], **cone)
    assert near.kind.tolist() == [["no-whisker", "slip-off"], ["slip-off", "slip-off"]]
    assert near.push_angle_deg[0, 1] == alone.push_angle_deg[0]
    assert list(near.refused) == [(0, 0)] and "0.2" in near.refused[0, 0]
    # A radius that no distance allows refuses them all.
    with pytest.raises(wm.SceneError, match=r"pole\.radius_mm = -0\.25"):
        wm.detachment(pole_radius_mm=-0.25, distance_mm=[11.0, 12.0], **cone)
