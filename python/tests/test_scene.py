"""Scenes: from files and from values, changed, pasted, pickled, refused."""

from __future__ import annotations

import copy
import pickle
from dataclasses import fields

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT

import whiskmap as wm
from whiskmap import _whiskmap
from whiskmap._description import PARAMETERS

SCENES = sorted((ROOT / "scenes").glob("*.toml"))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_survives_paste_pickle_and_file(path):
    scene = wm.Scene.read(path)
    assert eval(repr(scene), {name: getattr(wm, name) for name in wm.__all__}) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene == copy.deepcopy(scene)
    assert wm.Scene.parse(scene.to_toml(), scene.name) == scene
    assert scene.name == path.stem or "name" in path.read_text()
    assert hash(scene) == hash(pickle.loads(pickle.dumps(scene)))


def test_values_make_the_scene_of_the_file(cone):
    whisker = wm.Whisker(
        length_mm=20, base_radius_um=30, taper=0.95, youngs_modulus_gpa=3, parabola_per_mm=0.02, vertex_mm=0
    )
    grid = wm.Grid(push_angle_deg=wm.Range(-70, 70, 512), distance_mm=wm.Range(2, 20, 512))
    built = wm.Scene(whisker=whisker, pole=wm.Pole(radius_mm=0.25), grid=grid, title=cone.title, name="cone")
    assert built.whisker.tip_radius_um == pytest.approx(1.5, abs=1e-14)
    assert built.replace(tip_radius_um=1.5) == cone
    arrays = built.replace(push_angle_deg=built.coords["push_angle_deg"], tip_radius_um=np.float32(1.5))
    assert arrays == cone and arrays != built.replace(friction=0.1)


def test_every_parameter_of_rust_is_an_argument():
    arguments = {field.name for field in fields(wm.Whisker)} - {"profile", "profile_smooth", "rest_points", "rest_degree", "yield_strain"}
    pole = {"pole_radius_mm", "friction"}
    assert arguments | pole == {name for name, *_ in _whiskmap.parameters()}
    assert "curvature_per_mm" in PARAMETERS


def test_replace_sets_sweeps_and_removes(cone):
    assert cone.replace(taper=0.5).whisker.tip_radius_um == 15
    sweep = cone.replace(taper=[0, 0.5, 1], pole_radius_mm=np.array([0.25, 0.5]))
    assert list(sweep.coords) == ["taper", "pole_radius_mm", "distance_mm", "push_angle_deg"]
    assert sweep.replace(taper=0.95, pole_radius_mm=0.25) == cone.replace(taper=0.95)
    assert cone.replace(parabola_per_mm=None, vertex_mm=None).whisker.parabola_per_mm is None
    assert cone.replace(uncertainty={"length_mm": 0.3}).uncertainty == {"length_mm": 0.3}
    measured = wm.Scene.read(ROOT / "scenes/measured.toml")
    rows = np.array(measured.whisker.profile)
    assert measured.replace(profile=rows) == measured
    smooth = measured.replace(profile_smooth=True)
    assert smooth.whisker.profile_smooth and np.array_equal(smooth.whisker.profile, rows) and smooth != measured
    assert smooth.profile_fit.degree > 0 and smooth.profile_fit.rms_um > 0 and measured.profile_fit is None
    assert smooth.replace(profile=rows) == smooth == wm.Scene.parse(smooth.to_toml(), smooth.name)
    assert smooth.replace(profile_smooth=False) == measured
    bare = smooth.replace(profile=None, base_radius_um=30, tip_radius_um=1.5)
    assert not bare.whisker.profile_smooth
    with pytest.raises(ValueError, match="profile_smooth = True: must be left out without profile"):
        bare.replace(profile_smooth=True)
    with pytest.raises(TypeError, match="profile_smooth = 1: must be True or False"):
        measured.replace(profile_smooth=1)


def test_traced_points_are_arrays():
    traced = wm.Scene.read(ROOT / "scenes/traced.toml")
    points = np.array(traced.whisker.rest_points)
    assert points.shape == (45, 2)
    whisker = wm.Whisker(base_radius_um=30, tip_radius_um=1.5, youngs_modulus_gpa=3, rest_points=points)
    built = wm.Scene(whisker=whisker, pole=traced.pole, grid=traced.grid, title=traced.title, name=traced.name)
    assert built == traced and built.whisker.length_mm == traced.whisker.length_mm
    assert traced.replace(rest_degree=1) != traced == traced.replace(rest_points=points)
    assert traced.replace(rest_points=None).whisker.rest_points is None
    with pytest.raises(wm.SceneError, match="must not fold back") as refused:
        traced.replace(rest_points=points[::-1][np.r_[:30, 20:45]])
    assert refused.value.key.startswith("whisker.rest.points[")
    with pytest.raises(ValueError, match="must have 2 numbers"):
        traced.replace(rest_points=[[1, 2, 3]])
    with pytest.raises(ValueError, match="must be left out without rest_points"):
        traced.replace(rest_points=None, rest_degree=2)


def test_refused_scenes_name_key_value_and_what_is_allowed(cone):
    with pytest.raises(wm.SceneError, match="whisker.length_mm = -1: must be between") as refused:
        cone.replace(length_mm=-1)
    assert (refused.value.key, refused.value.value) == ("whisker.length_mm", "-1")
    assert refused.value.allowed.startswith("must be between 0.001")
    again = pickle.loads(pickle.dumps(refused.value))
    assert (str(again), again.key) == (str(refused.value), refused.value.key)
    with pytest.raises(wm.SceneError, match="not.toml") as refused:
        wm.Scene.parse("length = ", "not")
    assert refused.value.key is None
    with pytest.raises(FileNotFoundError, match="nowhere.toml"):
        wm.Scene.read("nowhere.toml")


def test_replace_does_not_depend_on_the_order_of_keywords(cone):
    changes = {
        "taper": [0.5, 0.9],
        "pole_radius_mm": [0.1, 0.2],
        "base_radius_um": 40.0,
        "curvature_per_mm": [0.0, 0.02],
        "friction": 0.1,
        "distance_mm": [9.0, 12.0],
        "title": "Another",
    }
    wanted = cone.replace(**changes)
    for shift in range(len(changes)):
        names = [*changes][shift:] + [*changes][:shift]
        for order in (names, names[::-1]):
            changed = cone.replace(**{name: changes[name] for name in order})
            assert changed == wanted and list(changed.coords) == list(wanted.coords)


def test_profiles_and_traced_points_are_data_frames(cone):
    measured, traced = (wm.Scene.read(ROOT / f"scenes/{name}.toml") for name in ("measured", "traced"))
    rows = np.array(measured.whisker.profile)
    frame = pd.DataFrame({"radius_um": rows[:, 1], "note": "", "arc_length_mm": rows[:, 0]})
    points = np.array(traced.whisker.rest_points)
    xy = pd.DataFrame(points, columns=["x_mm", "y_mm"])
    for given in (rows, frame, frame.to_dict("list"), rows.tolist()):
        assert measured.replace(profile=given) == measured
    for given in (points, xy, xy.to_dict("list"), points.tolist()):
        assert traced.replace(rest_points=given) == traced
    whisker = wm.Whisker(base_radius_um=30, tip_radius_um=1.5, youngs_modulus_gpa=3, rest_points=xy)
    assert wm.Scene(whisker=whisker, pole=traced.pole, grid=traced.grid, title=traced.title, name=traced.name) == traced


def test_a_traced_shape_reports_its_fit(cone):
    traced = wm.Scene.read(ROOT / "scenes/traced.toml").replace(distance_mm=[9.0, 12.0])
    fit = traced.rest_fit
    assert cone.rest_fit is None and fit.is_degree_chosen and fit.degree == 2 and 0.02 < fit.rms_mm < 0.06
    assert traced.replace(rest_degree=3).rest_fit.degree == 3
    results = [wm.curve(traced), wm.branch(traced, 12.0), wm.branch(traced, 12.0, "both"), wm.shape(traced, 12.0, 5.0)]
    results += [wm.sensitivity(traced, 12.0)]
    results += [wm.whisk(traced, 12.0, [0, 1], [-1, 5]).samples, wm.whisk(traced, 12.0, [0, 1], [-1, 5]).events]
    for ds in results:
        frame = ds.to_dataframe()
        assert (frame.rest_degree == fit.degree).all() and (frame.rest_rms_mm == fit.rms_mm).all()
    assert "rest_degree" not in wm.curve(cone.replace(distance_mm=[9.0])).coords
