"""Courses in time and forces from curvature against the program's tables."""

from __future__ import annotations

import io
import warnings

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from conftest import ROOT, program

import whiskmap as wm

CONE = ROOT / "scenes/cone.toml"
FRAMES = ROOT / "scenes/frames.csv"


def table(*arguments: object) -> pd.DataFrame:
    return pd.read_csv(io.StringIO(program(*arguments)), keep_default_na=False, na_values=[""])


def same(ds: xr.Dataset, expected: pd.DataFrame) -> None:
    """Compare every column of a table with the variable of its name: all of its values, texts too."""
    for name in expected.columns:
        found, other = ds[name].values, expected[name]
        if found.dtype.kind == "U":
            assert list(found) == list(other.astype(object).fillna("")), name
        else:
            np.testing.assert_array_equal(found, other.astype(float), err_msg=name)


def sine(amplitude: float, hertz: float, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    time = np.arange(round(1000 * seconds) + 1) / 1000
    return time, amplitude * np.sin(2 * np.pi * hertz * time)


@pytest.mark.parametrize("friction", [0, 0.3])
def test_a_whisk_is_the_programs_tables(cone, friction, tmp_path):
    scene, path, angles = cone.replace(friction=friction), tmp_path / "scene.toml", ROOT / "scenes/whisking.csv"
    path.write_text(scene.to_toml())
    events = tmp_path / "events.csv"
    course = pd.read_csv(angles, comment="#")
    found = wm.whisk(scene, 15.66, course.time_s, course.angle_deg)
    same(found.samples, table("whisk", path, "--distance", 15.66, "--angles", angles, "--events", events))
    same(found.events, pd.read_csv(events, keep_default_na=False, na_values=[""]))
    assert found.samples.force_un.dims == ("time_s",) and found.samples.force_un.units == "uN"
    assert "slip-off" in found.events.event and found.lost_nj > 0
    assert (found.dissipated_nj > 0) == (friction > 0)


def test_a_texture_is_the_programs_tables(tmp_path):
    path = ROOT / "scenes/texture_cone.toml"
    files = {name: tmp_path / f"{name}.csv" for name in ("events", "dwells", "histogram")}
    options = [part for name, file in files.items() for part in (f"--{name}", file)]
    angles = tmp_path / "angles.csv"
    time, angle = sine(15, 0.2, 3)
    pd.DataFrame({"time_s": time, "angle_deg": angle}).to_csv(angles, index=False)
    found = wm.texture(wm.Scene.read(path), time, angle)
    same(found.samples, table("texture", path, "--angles", angles, *options))
    for name, ds in (("events", found.events), ("dwells", found.stays), ("histogram", found.histogram)):
        same(ds, pd.read_csv(files[name], keep_default_na=False, na_values=[""]))
    assert set(found.samples.phase.values) == {"stuck", "slipping", "free"} and found.reached > 10
    assert float(found.histogram.tip_time_s.sum()) == pytest.approx(3)


@pytest.mark.parametrize("model", [False, True])
def test_forces_are_the_programs_table(cone, model):
    expected = table("force", CONE, "--frames", FRAMES, *(["--model"] if model else []))
    same(wm.force(cone, FRAMES, model=model), expected)
    frame = pd.read_csv(FRAMES, comment="#")
    found = wm.force(cone, frame, model=model)
    same(found, expected)
    xr.testing.assert_identical(wm.force(cone, frame.to_dict("list"), model=model), found)
    assert np.nanmax(found.force_un) > 0 and found.reason.dims == ("time_s",)


def test_surfaces_stay_in_scenes():
    rough = wm.Scene.read(ROOT / "scenes/texture_cone.toml")
    assert isinstance(rough.surface, wm.Surface) and rough.replace(title="Another").surface == rough.surface
    other = wm.Surface(distance_mm=18, spacing_um=200, asperity_radius_um=10, length_mm=20, jitter=0.1, seed=7)
    changed = rough.replace(surface=other)
    assert changed.surface == other and changed != rough != changed.replace(surface=None)
    assert changed.replace(surface=rough.surface) == rough and rough.replace(surface=None).surface is None
    given = {name: getattr(rough, name) for name in ("whisker", "grid", "pole", "title", "name", "surface")}
    assert wm.Scene(**given) == rough
    with pytest.raises(wm.SceneError, match="surface.jitter") as refused:
        rough.replace(surface=wm.Surface(distance_mm=18, spacing_um=200, asperity_radius_um=10, length_mm=20, jitter=1))
    assert refused.value.key == "surface.jitter"
    with pytest.raises(TypeError, match="seed = 1.5: must be a whole number"):
        wm.Surface(distance_mm=18, spacing_um=200, asperity_radius_um=10, length_mm=20, seed=1.5)
    with pytest.raises(TypeError, match="surface = 3: must be a Surface"):
        rough.replace(surface=3)


def test_what_is_refused_is_named(cone):
    time, angle = sine(20, 10, 0.1)
    with pytest.raises(ValueError, match=r"time_s\[1\] = 0.099: must be more than the time before it, 0.1 s"):
        wm.whisk(cone, 15.66, time[::-1], angle)
    with pytest.raises(ValueError, match="begins in contact"):
        wm.whisk(cone, 15.66, time, angle + 1)
    with pytest.raises(ValueError, match="angle_deg: must have one dimension, has 2"):
        wm.whisk(cone, 15.66, time, angle[:, None])
    with pytest.raises(ValueError, match="3 times and 101 angles"):
        wm.whisk(cone, 15.66, time[:3], angle)
    with pytest.raises(wm.StateError, match="out of reach"):
        wm.whisk(cone, 25, time, angle)
    with pytest.raises(ValueError, match="has no surface"):
        wm.texture(cone, time, angle)
    rough = wm.Scene.read(ROOT / "scenes/texture_cone.toml")
    with pytest.raises(ValueError, match=r"angle_deg\[\d+\] = 9\d.*: must be between -90 and 90"):
        wm.texture(rough, time, 5 * angle)
    for call in (lambda scene: wm.texture(scene, time, angle), lambda scene: wm.force(scene, FRAMES)):
        with pytest.raises(ValueError, match="friction = 0.1: must be 0"):
            call(rough.replace(friction=0.1))
    with pytest.raises(ValueError, match="curvature_per_mm"):
        wm.force(cone, {"time_s": [0.0]})
    with pytest.raises(TypeError, match="frames = 3"):
        wm.force(cone, 3)


def test_a_start_in_contact_is_that_of_the_program(cone, tmp_path):
    time, angle = (values[30:] for values in sine(14, 5, 0.2))
    angles = tmp_path / "angles.csv"
    pd.DataFrame({"time_s": time, "angle_deg": angle}).to_csv(angles, index=False)
    options = ("whisk", CONE, "--distance", 15.66, "--angles", angles)
    for start in ("contact", "free"):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = wm.whisk(cone, 15.66, time, angle, start=start)
        same(found.samples, table(*options, "--start", start))
    with pytest.warns(wm.SceneWarning, match=r"first angle is 11\.\d* deg, beyond first touch: the whisker is assumed to be free"):
        assumed = wm.whisk(cone, 15.66, time, angle)
    xr.testing.assert_identical(assumed.samples, found.samples)


def test_a_start_that_is_impossible_is_refused(cone):
    with pytest.raises(ValueError, match="cannot begin in contact: the first angle is 20 deg; pushes on CB end at 15.609"):
        wm.whisk(cone, 15.66, [0, 1], [20, 0], start="contact")
    with pytest.raises(ValueError, match="choose the start `contact`"):
        wm.whisk(cone, 15.66, [0, 1], [1, 0])
    with pytest.raises(ValueError, match="start = 'touch': must be one of 'free', 'contact'"):
        wm.whisk(cone, 15.66, [0, 1], [0, 1], start="touch")


def test_a_refused_number_of_an_array_is_named(cone):
    time, angle = sine(20, 10, 0.01)
    broken = angle.copy()
    broken[3] = np.inf
    with pytest.raises(ValueError, match=r"angle_deg\[3\] = inf: must be between -360 and 360"):
        wm.whisk(cone, 15.66, time, broken)
    frame = pd.read_csv(FRAMES, comment="#")
    frame.loc[4, "at_arc_length_mm"] = 99
    with pytest.raises(ValueError, match=r"^frames\[4\]: at_arc_length_mm = 99"):
        wm.force(cone, frame)
    with pytest.raises(TypeError, match=r"frames\['time_s'\]\[1\] = \(\): must be a text or a number"):
        wm.force(cone, {"time_s": np.array([0.0, ()], dtype=object)})

def test_gaps_are_those_of_the_program(cone, tmp_path):
    time, angle = sine(14, 5, 0.2)
    angle[[20, 21, 90]] = np.nan
    angles = tmp_path / "angles.csv"
    pd.DataFrame({"time_s": time, "angle_deg": angle}).to_csv(angles, index=False)
    options = ("whisk", CONE, "--distance", 15.66, "--angles", angles)
    with pytest.warns(wm.SceneWarning, match="missing angles: 3, gaps: 2, the first at 0.02 s: the course continues"):
        bridged = wm.whisk(cone, 15.66, time, angle, bridge_s=0.003)
    same(bridged.samples, table(*options, "--bridge", "3ms"))
    with pytest.warns(wm.SceneWarning, match="after them the course is undecided"):
        same(wm.whisk(cone, 15.66, time, angle).samples, table(*options))
    with pytest.raises(ValueError, match="bridge_s = -1: must be at least 0, and finite"):
        wm.whisk(cone, 15.66, time, angle, bridge_s=-1)
    frame = pd.read_csv(FRAMES, comment="#")
    frame.loc[50, "curvature_per_mm"] = np.nan
    with pytest.warns(wm.SceneWarning, match="frames have no force"):
        assert wm.force(cone, frame).reason[50] == "missing"


def test_missing_angles_are_gaps(cone):
    time, angle = sine(14, 5, 0.2)
    missing = np.isin(np.arange(time.size), [20, 21, 90])
    with pytest.warns(wm.SceneWarning, match="missing angles: 3"):
        expected = wm.whisk(cone, 15.66, time, np.where(missing, np.nan, angle), bridge_s=0.003)
    for given in (
        [None if lost else value for value, lost in zip(angle, missing)],
        [pd.NA if lost else value for value, lost in zip(angle, missing)],
        pd.Series(angle, dtype="Float64").mask(missing),
        np.ma.masked_array(angle, missing),
    ):
        with pytest.warns(wm.SceneWarning, match="missing angles: 3"):
            xr.testing.assert_identical(wm.whisk(cone, 15.66, time, given, bridge_s=0.003).samples, expected.samples)
    with pytest.raises(TypeError, match=r"angle_deg\[1\] = '1 deg': must be a number"):
        wm.whisk(cone, 15.66, [0, 1], [None, "1 deg"])
    with pytest.raises(TypeError, match="angle_deg: must be real numbers"):
        wm.whisk(cone, 15.66, [0, 1], np.ma.masked_array(["0", "1"], [False, True]))


def test_a_baseline_is_that_of_the_program(cone):
    frame = pd.read_csv(FRAMES, comment="#")
    free = frame.contact_x_mm.isna().to_numpy()
    span = (float(frame.time_s[0]), float(frame.time_s[~free].min()) - 1e-6)
    found = wm.force(cone, frame, baseline_s=span)
    same(found, table("force", CONE, "--frames", FRAMES, "--baseline", f"{span[0]}..{span[1]}"))
    assert found.attrs["baseline_frames"] == int((frame.time_s <= span[1]).sum()) and found.attrs["baseline_sd_per_mm"] >= 0
    deviating = cone.replace(uncertainty={"curvature_sd_per_mm": 1e-3})
    assert deviating.uncertainty == {"curvature_sd_per_mm": 1e-3}
    sd = wm.force(deviating, frame.assign(contact=(~free).astype(int))).force_sd_un
    assert (sd[~free] > 0).all() and np.isnan(sd[free]).all()
    for baseline in ((1, 0), (0, 1, 2)):
        with pytest.raises(ValueError, match="must be a first and a later last time, in s"):
            wm.force(cone, frame, baseline_s=baseline)
    with pytest.raises(ValueError, match=r"^frames\[\d+\]: time_s = .*: is in contact"):
        wm.force(cone, frame, baseline_s=(0, 1e6))


def test_samples_have_the_curvature_at_an_arclength(cone, tmp_path):
    time, angle = sine(14, 5, 0.2)
    angles = tmp_path / "angles.csv"
    pd.DataFrame({"time_s": time, "angle_deg": angle}).to_csv(angles, index=False)
    options = ("--angles", angles, "--curvature-at", 2)
    same(wm.whisk(cone, 15.66, time, angle, curvature_at_mm=2).samples, table("whisk", CONE, "--distance", 15.66, *options))
    path = ROOT / "scenes/texture_cone.toml"
    same(wm.texture(wm.Scene.read(path), time, angle, curvature_at_mm=2).samples, table("texture", path, *options))
    with pytest.raises(ValueError, match="curvature_at_mm = 21: must be between 0 and 20"):
        wm.whisk(cone, 15.66, time, angle, curvature_at_mm=21)


def test_forces_of_a_follicle_refer_to_its_axis_or_to_the_base(cone, tmp_path):
    scene, path = cone.replace(follicle_stiffness_nnm_per_rad=5000), tmp_path / "scene.toml"
    path.write_text(scene.to_toml())
    found = {axis: wm.force(scene, FRAMES, model=True, axis=axis) for axis in ("follicle", "tangent")}
    for axis, forces in found.items():
        same(forces, table("force", path, "--frames", FRAMES, "--model", "--axis", axis))
    assert found["follicle"].force_un.max() > 1 and not found["follicle"].equals(found["tangent"])
    with pytest.raises(ValueError, match="axis = 'base': must be one of 'tangent', 'follicle'"):
        wm.force(scene, FRAMES, model=True, axis="base")


def test_arrays_that_are_combined_by_place_have_equal_labels(cone):
    time, angle = pd.Series([0, 0.1, 0.2]), pd.Series([0, 20.0, 30.0], index=[2, 1, 0])
    with pytest.raises(ValueError, match="^angle_deg: has other labels than time_s: arrays are combined by place"):
        wm.whisk(cone, 15.66, time, angle)
    rough = wm.Scene.read(ROOT / "scenes/texture_cone.toml")
    with pytest.raises(ValueError, match="angle_deg: has the dimension angle where time_s has time"):
        wm.texture(rough, xr.DataArray([0, 0.1], dims="time"), xr.DataArray([0.0, 1.0], dims="angle"))
    readings = {"base_moment_nnm": pd.Series([1.0, 2.0]), "base_force_x_un": pd.Series([1.0, 2.0], index=[1, 0])}
    with pytest.raises(ValueError, match=r"^readings\['base_force_x_un'\]: has other labels than readings\['base_moment_nnm'\]"):
        wm.locate(cone, readings)
    points = {"x_mm": pd.Series([0.0, 9.0, 18.0]), "y_mm": pd.Series([2.0, 1.0, 0.0], index=[2, 1, 0])}
    with pytest.raises(ValueError, match=r"^rest_points\['y_mm'\]: has other labels"):
        cone.replace(parabola_per_mm=None, vertex_mm=None, rest_points=points)
    # Equal labels, whatever they are, and arrays without labels.
    for labels in ([0, 1, 2], [2, 1, 0]):
        same = wm.whisk(cone, 15.66, time.set_axis(labels), pd.Series([0, 20.0, 30.0], index=labels))
        assert same.samples.angle_deg.values.tolist() == [0, 20, 30]
    assert wm.whisk(cone, 15.66, time, [0, 20.0, 30.0]).samples.sizes["time_s"] == 3


def test_an_index_of_pandas_has_no_labels(cone):
    time, angle = [0, 0.1, 0.2], [0, 20.0, 30.0]
    expected = wm.whisk(cone, 15.66, time, angle).samples
    shuffled = pd.Series(angle, index=[2, 1, 0])
    for given in ((pd.Index(time), shuffled), (pd.Series(time), pd.Index(angle)), (pd.Index(time), pd.Index(angle, dtype="Float64"))):
        xr.testing.assert_identical(wm.whisk(cone, 15.66, *given).samples, expected)
    for index, unit in ((pd.date_range("2026-01-01", periods=3), "datetime64"), (pd.to_timedelta(time, unit="s"), "timedelta64")):
        for given in (index, pd.Series(index)):
            with pytest.raises(TypeError, match=f"^time_s: must be real numbers without a unit, has the type {unit}"):
                wm.whisk(cone, 15.66, given, angle)
    readings = readings_of(cone)
    indexes = {name: pd.Index(values) for name, values in readings.items()}
    xr.testing.assert_identical(wm.locate(cone, indexes), wm.locate(cone, readings))


def test_columns_of_a_dataset_have_one_dimension(cone):
    readings = readings_of(cone)
    dataset = xr.Dataset({name: ("row", values) for name, values in readings.items()})
    xr.testing.assert_identical(wm.locate(cone, dataset), wm.locate(cone, readings))
    dataset["base_force_y_un"] = dataset.base_force_y_un.rename(row="column")
    with pytest.raises(ValueError, match=r"^readings\['base_force_y_un'\]: has the dimension column where readings\['base_moment_nnm'\] has row"):
        wm.locate(cone, dataset)


def readings_of(scene: wm.Scene) -> dict[str, list[float]]:
    states = [wm.shape(scene, 12.0, push, points=3).attrs for push in (5.0, 10.0)]
    return {name: [state[name] for state in states] for name in ("base_moment_nnm", "base_force_y_un")}
