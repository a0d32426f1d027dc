"""Curves, branches, shapes, fits and designs against the program's tables and the reference points."""

from __future__ import annotations

import io

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from conftest import ROOT, program

import whiskmap as wm

CONE = ROOT / "scenes/cone.toml"


def table(*arguments: object) -> pd.DataFrame:
    return pd.read_csv(io.StringIO(program(*arguments)), keep_default_na=False, na_values=[""])


def same(ds: xr.Dataset, expected: pd.DataFrame) -> None:
    """Compare every column of a table with the variable of its name."""
    for name in expected.columns.drop(["part", "sliding"], errors="ignore"):
        found = ds[name] if name in ds else ds.attrs[name]
        if expected[name].dtype.kind == "f":
            np.testing.assert_array_equal(np.broadcast_to(found, len(expected)), expected[name], err_msg=name)


def test_a_curve_is_the_programs_table():
    scene = wm.Scene.read(CONE).replace(distance_mm=[5.0, 15.66, 19.0, 20.0])
    expected = table("curve", CONE, "--distance", "5,15.66,19,20")
    frame = wm.curve(scene).to_dataframe().reset_index()
    assert set(frame.columns) == set(expected.columns)
    for name in expected:
        found, other = frame[name], expected[name]
        if other.dtype.kind == "f" and name != "sliding":
            np.testing.assert_array_equal(found, other, err_msg=name)
        else:
            assert list(found) == list(other.astype(object).fillna("")), name


def test_a_sweep_of_curves_has_whiskers_in_their_places():
    scene = wm.Scene.read(CONE).replace(distance_mm=[12.0, 15.0], taper=[0.5, 0.9], pole_radius_mm=[0.1, 0.2, 0.3])
    ds = wm.curve(scene, threads=2)
    single = wm.curve(scene.replace(taper=0.9, pole_radius_mm=0.2))
    xr.testing.assert_equal(ds.sel(taper=0.9, pole_radius_mm=0.2, drop=True), single)


def test_branches_and_shapes_are_the_programs_tables(cone):
    same(wm.branch(cone, 15.66, "cf", points=50), table("branch", CONE, "--distance", 15.66, "--side", "cf", "--points", 50))
    ds = wm.shape(cone, 15.66, 10, points=60)
    same(ds, table("shape", CONE, "--distance", 15.66, "--push-angle", 10, "--points", 60))
    assert np.hypot(ds.pole_x_mm - ds.x_mm, ds.pole_y_mm - ds.y_mm).min() == pytest.approx(0.25, abs=1e-9)
    for name in ("CF", "Cf"):
        xr.testing.assert_identical(wm.branch(cone, 15.66, name, points=50), wm.branch(cone, 15.66, "cf", points=50))
    both = wm.branch(cone, 15.66, "both", points=50)
    for name in ("cf", "cb"):
        xr.testing.assert_equal(both.sel(side=name, drop=True), wm.branch(cone, 15.66, name, points=50))
    with pytest.raises(wm.StateError, match="slipped off at 15.6"):
        wm.shape(cone, 15.66, 20)
    with pytest.raises(wm.StateError, match="out of reach"):
        wm.branch(cone, 25)


def test_fits_and_designs_are_the_programs(cone):
    free = ["tip_radius_um", "parabola_per_mm"]
    points = ROOT / "scenes/cone_points.csv"
    fit = wm.fit(cone, points, free)
    assert fit.not_a_fit is None and fit.is_explained and fit.degrees_of_freedom == 27
    assert f"{fit.estimates.value[0].item():.2f}" in program("fit", CONE, "--data", points, "--free", ",".join(free))
    frame = pd.read_csv(points, comment="#")
    xr.testing.assert_equal(wm.fit(cone, frame, free).estimates, fit.estimates)
    xr.testing.assert_equal(wm.fit(cone, frame.to_dict("list"), free).estimates, fit.estimates)
    assert fit.scene.whisker.tip_radius_um == fit.estimates.value[0]
    design = wm.design(cone, "tip_radius_um", distance_mm=15.66, slip_off_deg=20)
    assert list(design.sides) == ["cb"] and (design.ends.side == "cb").all()
    for side in ("both", "CB"):
        again = wm.design(cone, "tip_radius_um", distance_mm=15.66, slip_off_deg=20, side=side)
        np.testing.assert_array_equal(again.values, design.values)
    designs = {name: wm.design(cone, "tip_radius_um", distance_mm=15.66, side=name, max_force_un=20) for name in ("cb", "CF", "both")}
    both = designs["both"]
    assert list(both.values) == sorted([*designs["cb"].values, *designs["CF"].values]) and set(both.sides) == {name.lower() for name in ("cb", "CF") if len(designs[name].values)}
    assert design.values == pytest.approx([4.063], abs=1e-3) and set(design.ends.kind.values) >= {"slip-off"}


def test_a_shape_may_have_two_points(cone):
    ds = wm.shape(cone, 15.66, 10, points=2)
    same(ds, table("shape", CONE, "--distance", 15.66, "--push-angle", 10, "--points", 2))
    # Base and tip, and the contact.
    assert ds.sizes["point"] == 3


def test_a_kind_may_be_missing(cone):
    """Every missing value of a data frame, and every text of one in a file, is a point of unknown kind."""
    frame = pd.read_csv(ROOT / "scenes/cone_points.csv", comment="#")
    free = ["tip_radius_um", "parabola_per_mm"]
    expected = wm.fit(cone, frame.drop(columns="kind", errors="ignore"), free)
    for missing in (None, np.nan, pd.NA, pd.NaT, np.datetime64("NaT"), np.ma.masked, "", "NaN", "nan", "NA", "N/A", "null", "none"):
        found = wm.fit(cone, {**frame.to_dict("list"), "kind": ["slip-off", *[missing] * (len(frame) - 1)]}, free)
        assert found.points.kind.values.tolist() == ["slip-off"] + [""] * (len(frame) - 1), missing
        xr.testing.assert_identical(found.estimates, expected.estimates)
    for kinds in (pd.Series([pd.NaT] * len(frame)), pd.Categorical(["slip-off"] + [None] * (len(frame) - 1)), pd.Series([None] * len(frame), dtype="string")):
        xr.testing.assert_identical(wm.fit(cone, frame.assign(kind=kinds), free).estimates, expected.estimates)
    with pytest.raises(ValueError, match=r"points\[0\]: kind = slip: must be slip-off, pull-off or empty"):
        wm.fit(cone, frame.assign(kind="slip"), free)


def test_robust_fits_are_those_of_scipy(cone):
    optimize = pytest.importorskip("scipy.optimize")
    frame = pd.read_csv(ROOT / "scenes/cone_points.csv", comment="#")
    frame.loc[[3, 11], "push_angle_deg"] += 15.0
    names = ["tip_radius_um", "parabola_per_mm"]
    deviations = frame["sd_deg"] if "sd_deg" in frame else 1.0

    def residuals(x):
        end = wm.detachment(cone, distance_mm=frame.distance_mm, side=frame.side, tip_radius_um=x[0], parabola_per_mm=x[1])
        return (end.push_angle_deg - frame.push_angle_deg) / deviations

    for loss, name in (("soft_l1", "soft-l1"), ("huber", "huber")):
        options = {"ftol": 1e-14, "xtol": 1e-14, "gtol": 1e-14}
        found = optimize.least_squares(residuals, [2.4, 0.018], loss=loss, x_scale=[1, 0.01], diff_step=1e-6, **options)
        with pytest.warns(wm.SceneWarning, match="outlier"):
            fit = wm.fit(cone, frame, names, loss=name)
        np.testing.assert_allclose(fit.estimates.value, found.x, rtol=2e-6)
        assert fit.chi_square == pytest.approx(2 * found.cost, rel=1e-9)
        assert (fit.pulls.weight < 1.01).all() and set(fit.pulls.parameter.values) <= set(names)
    with pytest.raises(ValueError, match="loss = 'cauchy': must be one of 'squares', 'soft-l1', 'huber'"):
        wm.fit(cone, frame, names, loss="cauchy")


def test_own_names_of_columns(cone):
    frame = pd.read_csv(ROOT / "scenes/cone_points.csv", comment="#")
    renamed = frame.rename(columns={"push_angle_deg": "angle", "distance_mm": "d"})
    free = ["tip_radius_um", "parabola_per_mm"]
    fit = wm.fit(cone, renamed, free, columns={"push": "angle", "distance_mm": "d"})
    xr.testing.assert_equal(fit.estimates, wm.fit(cone, frame, free).estimates)
    with pytest.raises(ValueError, match="points: columns push=winkel: `winkel` is no column of the file"):
        wm.fit(cone, renamed, free, columns={"push": "winkel"})
    with pytest.raises(TypeError, match="must be own names of columns by expected ones"):
        wm.fit(cone, renamed, free, columns=["angle"])
    readings = wm.locate(cone, {"Mz": [60], "Fy": [6]}, columns={"base_moment": "Mz", "base_force_y_un": "Fy"})
    xr.testing.assert_equal(readings, wm.locate(cone, {"base_moment_nnm": [60], "base_force_y_un": [6]}))


def test_several_parameters_reach_as_many_targets():
    robot = wm.Scene.read(ROOT / "scenes/robot.toml")
    found = wm.design(robot, ["base_radius_um", "taper"], distance_mm=60, slip_off_deg=30, max_moment_nnm=5e6)
    assert found.values.shape == (1, 2) and list(found.sides) == ["cb"] and found.nearest is None
    assert found.values[0, 1] == pytest.approx(0.9354536238, abs=1e-6)
    part = wm.design(robot, ["base_radius_um", "taper"], distance_to_length=60 / robot.whisker.length_mm, slip_off_deg=30, max_moment_nnm=5e6)
    np.testing.assert_allclose(part.values, found.values, rtol=1e-6)
    narrow = {"base_radius_um": (10, 20), "taper": None}
    none = wm.design(robot, narrow, distance_mm=60, slip_off_deg=30, max_moment_nnm=5e6)
    assert none.values.shape == (0, 2) and none.nearest.at_limit.sel(parameter="base_radius_um")
    distance = wm.design(robot, "distance_mm", slip_off_deg=30)
    assert all(wm.design(robot, "distance_mm", slip_off_deg=30).values == distance.values)
    kept = wm.design(robot, "base_radius_um", distance_mm=60, side="cb", max_moment_nnm=1e6, keep="taper")
    assert len(kept.values) == 1
    for wrong, said in [
        ({"distance_mm": 60}, "exactly 2 of"),
        ({"slip_off_deg": 30, "max_strain": 1}, "the distance must be one of"),
        ({"slip_off_deg": 30, "max_strain": 1, "distance_mm": 1, "distance_to_length": 1}, "the distance must be one of"),
    ]:
        with pytest.raises(TypeError, match=said):
            wm.design(robot, ["base_radius_um", "taper"], **wrong)
    with pytest.raises(ValueError, match="must be a least and a greatest value"):
        wm.design(robot, {"taper": (1, 0)}, distance_mm=60, slip_off_deg=30)


def test_sensitivities_are_those_of_the_program(cone):
    ds = wm.sensitivity(cone, [12.0, 15.66])
    rows = table("sensitivity", CONE, "--distance", 15.66)
    assert len(rows) > 10
    for _, row in rows.iterrows():
        by = ds.d_push_angle_deg.sel(variable=row.variable, side=row.side, distance_mm=15.66)
        assert by.item() == pytest.approx(row.d_push_deg, rel=1e-9, abs=1e-12)
    assert ds["value"].sel(variable="taper") == pytest.approx(0.95) and ds.units.sel(variable="length_mm") == "mm"
    assert wm.sensitivity(cone).sizes["distance_mm"] == 512
