"""Tables of whiskers: rows of data frames, and arrays with missing values."""

from __future__ import annotations

import pickle
import re

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import whiskmap as wm

PAD = pd.DataFrame(
    {
        "name": ["C1", "C2", "C3"],
        "length_mm": [20.0, 18.0, 16.0],
        "base_radius_um": pd.array([30.0, None, 26.0], dtype="Float64"),
        "tip_radius_um": [1.5, 2.0, 2.0],
    }
)


@pytest.fixture
def pad():
    whisker = wm.Whisker(youngs_modulus_gpa=3)
    return wm.Scene(whisker=whisker, grid=wm.Grid(push_angle_deg=wm.Range(-60, 60, 25), distance_mm=[5, 10]), table=PAD)


def alone(scene, row):
    numbers = PAD.iloc[row].drop("name").astype(float)
    return scene.replace(table=None, **numbers)


def test_rows_have_the_results_of_their_whiskers(pad):
    assert pad.refused == {"C2": "base_radius_um is missing"}
    ends, cells = wm.curve(pad), wm.map(pad)
    assert ends.whisker.values.tolist() == ["C1", "C2", "C3"] and ends.kind.dims == ("whisker", "side", "distance_mm")
    assert (ends.kind.sel(whisker="C2") == "no-whisker").all() and np.isnan(ends.push_angle_deg.sel(whisker="C2")).all()
    assert (cells.regime.sel(whisker="C2") == 255).all()
    for row in (0, 2):
        single, name = alone(pad, row), PAD["name"][row]
        assert pad.select(name).whisker == single.whisker
        np.testing.assert_array_equal(ends.force_un.sel(whisker=name), wm.curve(single).force_un)
        np.testing.assert_array_equal(cells.force_un.sel(whisker=name), wm.map(single).force_un)
    lazy = wm.map(pad, lazy=True)
    np.testing.assert_array_equal(lazy.force_un.sel(whisker="C3"), cells.force_un.sel(whisker="C3"))


def test_tables_survive_texts_pickles_and_replacements(pad, tmp_path):
    assert wm.Scene.parse(pad.to_toml()).refused == pad.refused
    again = pickle.loads(pickle.dumps(pad))
    assert again == pad and again.coords["whisker"].tolist() == PAD["name"].tolist()
    assert pad.table[1] == {"name": "C2", "length_mm": 18.0, "base_radius_um": None, "tip_radius_um": 2.0}
    assert pad.replace(table=pad.table) == pad
    thick = pad.replace(pole_radius_mm=0.5)
    assert thick.refused == pad.refused and thick.select("C3").pole.radius_mm == 0.5
    assert pad.replace(table={"name": ["A"], "length_mm": [12], "base_radius_um": [20], "taper": [0.9]}).coords["whisker"].tolist() == ["A"]
    traced = {"name": ["A", "B"], "profile": [[[0, 30], [20, 2]], None], "length_mm": [20, np.nan]}
    traced["rest_points"] = [None, pd.DataFrame({"x_mm": np.arange(0, 20.0, 2), "y_mm": 0.01 * np.arange(0, 20.0, 2) ** 2})]
    traced["base_radius_um"], traced["tip_radius_um"] = [np.nan, 30], [np.nan, 2]
    both = pad.replace(table=traced)
    assert both.refused == {} and both.select("A").whisker.profile and both.select("B").rest_fit.degree >= 0


@pytest.mark.parametrize("dtype", [int, float, np.int8, "Int64", str, object])
def test_names_may_be_whole_numbers(pad, dtype):
    """A number from a data frame is the name of its digits, also where pandas makes it a float."""
    numbers = pd.Series([1, 2, 3, 4, 5])
    sizes = {"length_mm": [16.0, 17.0, 18.0, 19.0, 20.0], "base_radius_um": [30.0] * 5, "tip_radius_um": [2.0] * 5}
    scene = pad.replace(table=pd.DataFrame({"name": numbers.astype(dtype), **sizes}), pole_radius_mm=0.25)
    assert scene.coords["whisker"].tolist() == ["1", "2", "3", "4", "5"]
    assert scene.select(1) == scene.select("1") and scene.select(np.int64(5)).whisker.length_mm == 20
    ends = wm.curve(scene).sel(side="cb", distance_mm=10)
    points = pd.DataFrame({"whisker": numbers.astype(dtype), "side": "cb", "distance_mm": 10.0, "push_angle_deg": ends.push_angle_deg.values})
    fit = wm.fit(scene, points, ["pole_radius_mm"])
    assert abs(fit.points.residual_deg).max() < 1e-3
    for name in (True, None, [1]):
        with pytest.raises(TypeError, match=re.escape(f"whisker = {name}: must be a text or a number")):
            scene.select(name)


def test_wrong_tables_are_refused(pad):
    for table, error, said in [
        (3, TypeError, "table = 3: must be a DataFrame, a mapping of columns, or a list of mappings"),
        ({"length_mm": [20]}, ValueError, r"table\[0\]: must have a name"),
        ([3], TypeError, r"table\[0\] = 3: must be a mapping"),
        ({"name": ["A"], "length_mm": [20, 21]}, ValueError, "table: columns must be equally long, have 1 and 2 values"),
        ({"name": ["A"], "length_mm": ["20 mm"]}, TypeError, r"table\[0\]\['length_mm'\] = '20 mm': must be a number"),
        ({"name": np.ma.array(["A", "B"], mask=[False, True]), "length_mm": [20, 20]}, wm.SceneError, r"whiskers.table\[1\]: the name of the whisker is missing"),
        ({"name": ["A", None], "length_mm": [20, 20]}, wm.SceneError, r"whiskers.table\[1\]: the name of the whisker is missing"),
        (pd.DataFrame({"name": ["A", np.nan]}), wm.SceneError, r"whiskers.table\[1\]: the name of the whisker is missing"),
        (pd.DataFrame([["A", 20, 21]], columns=["name", "length_mm", "length_mm"]), ValueError, "table: has the column length_mm 2 times"),
        ({"name": ["A"], "length_mm": [np.nan]}, wm.SceneError, "must have a row with a whisker; row 1: length_mm is missing"),
    ]:
        with pytest.raises(error, match=said):
            pad.replace(table=table)
    assert pad.replace(youngs_modulus_gpa=4, length_mm=None).whisker.youngs_modulus_gpa == 4
    with pytest.raises(KeyError, match="there is no whisker D1"):
        pad.select("D1")
    with pytest.raises(KeyError, match="C2: base_radius_um is missing"):
        pad.select("C2")


def test_rows_of_columns_have_equal_labels(pad):
    sizes = {"length_mm": [20.0, 25.0], "base_radius_um": [30.0, 20.0], "taper": [0.9, 0.95]}
    plain = pad.replace(table={"name": ["a", "b"], **sizes})

    def table(kind, labels, names=None):
        own = {name: kind(values, labels if name == "base_radius_um" else [0, 1]) for name, values in sizes.items()}
        return {"name": ["a", "b"] if names is None else names, **own}

    def array(values, labels):
        return xr.DataArray(values, dims="whisker", coords={"whisker": labels})

    for kind, names in ((pd.Series, None), (pd.Series, pd.Series(["a", "b"])), (array, None), (pd.Series, pd.Index(["a", "b"]))):
        assert pad.replace(table=table(kind, [0, 1], names)) == plain
        with pytest.raises(ValueError, match=r"^table\['base_radius_um'\]: has other labels than table\['(name|length_mm)'\]: arrays are combined"):
            pad.replace(table=table(kind, [1, 0], names))
    other = table(array, [0, 1])
    other["taper"] = other["taper"].rename(whisker="row")
    with pytest.raises(ValueError, match=r"^table\['taper'\]: has the dimension row where table\['length_mm'\] has whisker"):
        pad.replace(table=other)
    # Measured radii have further axes after that of the whiskers.
    profile = xr.DataArray([[[0, 30], [20, 2]], [[0, 30], [20, 3]]], dims=("whisker", "row", "column"))
    measured = {"name": ["a", "b"], "length_mm": array([20.0, 20.0], [0, 1])}
    assert pad.replace(table=measured | {"profile": profile}) == pad.replace(table=measured | {"profile": profile.values.tolist()})
    with pytest.raises(ValueError, match=r"^table\['profile'\]: has the dimension row where"):
        pad.replace(table=measured | {"profile": profile.transpose("row", "whisker", "column")})


def test_other_columns_are_named(pad):
    numbers = {"name": ["A"], "length_mm": [20], "base_radius_um": [30], "tip_radius_um": [2]}
    with pytest.warns(wm.SceneWarning, match="table: columns that are not used: remark, tapper; `tapper` is not known; did you mean `taper`"):
        named = pad.replace(table=pd.DataFrame(numbers | {"remark": ["good"], "tapper": [0.9]}))
    assert named.table == pad.replace(table=numbers).table
    with pytest.raises(ValueError, match="table: has the column length_cm; values must be in mm: convert them, and use the name `length_mm`"):
        pad.replace(table=[{"name": "A", "length_cm": 2}])
    bent = [pad.replace(table=numbers | {column: [0.01]}) for column in ("parabola_per_mm", "curvature_per_mm")]
    assert bent[0] == bent[1]


def test_missing_elements_leave_the_others():
    cone = dict(length_mm=20.0, youngs_modulus_gpa=3.0, parabola_per_mm=0.02)
    radius, taper = np.array([30, np.nan, 33, 30]), np.array([0.9, 0.9, 1.5, 0.8])
    ends = wm.detachment(base_radius_um=radius, taper=taper, distance_mm=[[12.0], [15.0], [np.nan]], side="cb", jac=True, **cone)
    assert ends.kind.shape == (3, 4) and ends.jac["force_un"].shape == (3, 4, 5)
    is_there = ends.kind != "no-whisker"
    assert is_there.tolist() == [[True, False, False, True]] * 2 + [[False] * 4]
    assert set(ends.refused) == {tuple(place) for place in np.argwhere(~is_there).tolist()}
    assert ends.refused[0, 1] == "base_radius_um is missing" and ends.refused[2, 0] == "distance_mm is missing"
    assert ends.refused[1, 2].startswith("taper[2] = 1.5: must be between 0 and 1")
    for place in np.argwhere(is_there).tolist():
        row, column = place
        single = wm.detachment(base_radius_um=radius[column], taper=taper[column], distance_mm=[12.0, 15.0][row], side="cb", **cone)
        assert single.force_un == pytest.approx(ends.force_un[row, column], rel=1e-9) and single.refused == {}
    assert np.isfinite(ends.jac["force_un"][is_there]).all() and np.isnan(ends.force_un[~is_there]).all()
    # A refused distance leaves the others of its whisker.
    some = wm.detachment(base_radius_um=30, taper=0.9, distance_mm=[12, 300, 15, 0.001], side="cb", **cone)
    assert (some.kind == "no-whisker").tolist() == [False, True, False, True]
