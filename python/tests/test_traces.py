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
        own = ds[name] if name in ds else ds.attrs[name]
        if expected[name].dtype.kind == "f":
            np.testing.assert_array_equal(np.broadcast_to(own, len(expected)), expected[name], err_msg=name)


def test_a_curve_is_the_programs_table():
    scene = wm.Scene.read(CONE).replace(distance_mm=[5.0, 15.66, 19.0, 20.0])
    expected = table("curve", CONE, "--distance", "5,15.66,19,20")
    frame = wm.curve(scene).to_dataframe().reset_index()
    assert set(frame.columns) == set(expected.columns)
    for name in expected:
        own, other = frame[name], expected[name]
        if other.dtype.kind == "f" and name != "sliding":
            np.testing.assert_array_equal(own, other, err_msg=name)
        else:
            assert list(own) == list(other.astype(object).fillna("")), name


def test_a_sweep_of_curves_has_whiskers_in_their_places():
    scene = wm.Scene.read(CONE).replace(distance_mm=[12.0, 15.0], taper=[0.5, 0.9], pole_radius_mm=[0.1, 0.2, 0.3])
    ds = wm.curve(scene, threads=2)
    own = wm.curve(scene.replace(taper=0.9, pole_radius_mm=0.2))
    xr.testing.assert_equal(ds.sel(taper=0.9, pole_radius_mm=0.2, drop=True), own)


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
    own = {name: wm.design(cone, "tip_radius_um", distance_mm=15.66, side=name, max_force_un=20) for name in ("cb", "CF", "both")}
    both = own["both"]
    assert list(both.values) == sorted([*own["cb"].values, *own["CF"].values]) and set(both.sides) == {name.lower() for name in ("cb", "CF") if len(own[name].values)}
    assert design.values == pytest.approx([4.063], abs=1e-3) and set(design.ends.kind.values) >= {"slip-off"}


def test_reference_points_of_another_solver():
    """40 points of AUTO-07p, as the Rust tests have them: the angles have 9 decimals."""
    points = pd.read_csv(ROOT / "tests/data/detachment.csv")
    points = points[points.modulus_gradient == 0]
    names = ["length_mm", "base_radius_um", "tip_radius_um", "parabola_per_mm", "vertex_mm", "pole_radius_mm", "distance_mm"]
    given = {name: points[name].to_numpy() for name in names} | {"arc_stretch": points.projection}
    end = wm.detachment(side=points.side.str.lower(), youngs_modulus_gpa=3, **given)
    assert len(points) > 30 and (end.kind == points.kind).all()
    np.testing.assert_allclose(end.push_angle_deg, points.push_angle_deg, rtol=0, atol=1e-8)
    np.testing.assert_allclose(end.arc_length_mm, points.arc_length_mm, rtol=0, atol=2e-7)


def test_sensitivities_are_those_of_detachments(cone):
    ds = wm.sensitivity(cone, [12.0, 15.66])
    taper = ds.d_push_angle_deg.sel(variable="taper", side="cb").values
    steps = [wm.curve(cone.replace(taper=0.95 + step, distance_mm=[12.0, 15.66])).push_angle_deg.sel(side="cb") for step in (1e-5, -1e-5)]
    np.testing.assert_allclose(taper, (steps[0] - steps[1]) / 2e-5, rtol=1e-6)
    assert ds["value"].sel(variable="taper") == pytest.approx(0.95) and ds.units.sel(variable="length_mm") == "mm"
    assert wm.sensitivity(cone).sizes["distance_mm"] == 512
