"""Warnings of the program are warnings of Python, at the lines of the caller."""

from __future__ import annotations

import pickle
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT

import whiskmap as wm

MODULUS = "whisker.youngs_modulus_gpa = 3000 GPa: expected 0.1 to 250 GPa; is it in MPa?"


def issued(call) -> list[str]:
    """Call a function and return the texts of its warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert all(warning.category is wm.SceneWarning for warning in caught), caught
    # Each is issued at the line of the caller, here that of the function.
    assert all(warning.filename == __file__ for warning in caught), caught
    return [str(warning.message) for warning in caught]


def printed(*arguments: object) -> list[str]:
    """Return the warnings that the program prints, and the note about a moved start."""
    command = [Path(sys.executable).parent / "whiskmap", *map(str, arguments)]
    lines = subprocess.run(command, capture_output=True, text=True).stderr.splitlines()
    kept = (line.partition(": ") for line in lines if line.startswith("warning: ") or "starts at" in line)
    return [text for _, _, text in kept]


def test_a_number_in_another_unit_is_warned_of(cone, tmp_path):
    assert issubclass(wm.SceneWarning, UserWarning)
    text = cone.to_toml().replace("youngs_modulus_gpa = 3", "youngs_modulus_gpa = 3000")
    path = tmp_path / "scene.toml"
    path.write_text(text)
    whisker = wm.Whisker(length_mm=20, base_radius_um=30, taper=0.95, youngs_modulus_gpa=3000)
    for call in (
        lambda: wm.Scene.read(path),
        lambda: wm.Scene.parse(text),
        lambda: cone.replace(youngs_modulus_gpa=3000),
        lambda: wm.Scene(whisker=whisker, grid=cone.grid),
    ):
        assert issued(call) == [MODULUS]
    assert printed("curve", path, "--distance", 9, "--csv", tmp_path / "curve.csv") == [MODULUS]
    assert issued(lambda: wm.Scene.read(ROOT / "scenes/cone.toml")) == []


def test_a_copy_of_a_scene_does_not_warn_again(cone):
    with pytest.warns(wm.SceneWarning):
        odd = cone.replace(youngs_modulus_gpa=3000)
    assert issued(lambda: pickle.loads(pickle.dumps(odd))) == []
    assert issued(lambda: wm.curve(odd)) == []


def test_a_warning_is_shown_once_a_place():
    code = """
import sys, whiskmap as wm
cone = wm.Scene.read(sys.argv[1])
for _ in range(3):
    cone.replace(youngs_modulus_gpa=3000)
cone.replace(youngs_modulus_gpa=3000)
"""
    done = subprocess.run([sys.executable, "-c", code, ROOT / "scenes/cone.toml"], capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr.count("SceneWarning") == 2, done.stderr


@pytest.fixture
def points() -> pd.DataFrame:
    return pd.read_csv(ROOT / "scenes/cone_points.csv", comment="#")


def fitted(cone, points, free, tmp_path) -> list[str]:
    """Fit, and return the warnings, which are those of the program."""
    path, scene = tmp_path / "points.csv", tmp_path / "scene.toml"
    points.to_csv(path, index=False)
    scene.write_text(cone.to_toml())
    found = issued(lambda: wm.fit(cone, path, free))
    program = printed("fit", scene, "--data", path, "--free", ",".join(free))
    assert sorted(found) == sorted(program)
    return found


def test_a_good_fit_does_not_warn(cone, points, tmp_path):
    assert fitted(cone, points, ["tip_radius_um", "parabola_per_mm"], tmp_path) == []


def test_angles_of_the_other_side_are_warned_of(cone, points, tmp_path):
    points.loc[3, "push_angle_deg"] *= -1
    found = fitted(cone, points.drop(columns="sd_deg"), ["tip_radius_um", "parabola_per_mm"], tmp_path)
    assert found[0].startswith("1 of ") and "have an angle of the other side's sign" in found[0]


def test_large_residuals_are_warned_of(cone, points, tmp_path):
    points["sd_deg"] /= 10
    found = fitted(cone, points, ["tip_radius_um", "parabola_per_mm"], tmp_path)
    assert [text for text in found if "times as large as sd_deg" in text]


def test_an_undetermined_parameter_is_warned_of(cone, points, tmp_path):
    found = fitted(cone, points, ["tip_radius_um", "youngs_modulus_gpa"], tmp_path)
    assert "youngs_modulus_gpa: not determined by these points" in found


def test_a_moved_start_is_warned_of(cone, points, tmp_path):
    short = cone.replace(length_mm=17.5, distance_mm=[10.0])
    found = fitted(short, points, ["length_mm", "tip_radius_um"], tmp_path)
    assert [text for text in found if "length_mm starts at" in text]
    # Of columns, a message names the index instead of the line of a file.
    named = issued(lambda: wm.fit(short, points, ["length_mm", "tip_radius_um"]))
    assert [text for text in named if text.startswith("points[") and "length_mm starts at" in text]


def test_frames_without_a_force_are_warned_of(cone):
    frame = pd.read_csv(ROOT / "scenes/frames.csv", comment="#")
    touched = frame.index[frame.contact_x_mm.notnull()]
    frame.loc[touched[0], "contact_x_mm"] = -5.0
    found = issued(lambda: wm.force(cone, frame))
    assert found == [f"1 of {len(frame)} frames have no force, for the reasons in the table"]


def test_undecided_samples_are_warned_of(cone):
    near = cone.replace(pole_radius_mm=4.0, distance_mm=[17.0])
    angle = np.linspace(-1, 60, 400)
    found = []
    for distance in (17.0, 18.0, 19.0, 19.5):
        found += issued(lambda: wm.whisk(near, distance, np.arange(angle.size) / 100, angle))
    assert found and all("samples are undecided" in text for text in found)


def test_an_engine_without_expansions_is_warned_of():
    measured = wm.Scene.read(ROOT / "scenes/measured.toml").replace(push_angle_deg=[-5, 5], distance_mm=[9, 12])
    found = issued(lambda: wm.map(measured, engine="spectral"))
    assert len(found) == 1 and "measured radii has no expansions" in found[0]
    assert issued(lambda: wm.map(measured, engine="cpu")) == []
