"""Courses in time and forces from curvature against the program's tables."""

from __future__ import annotations

import io

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
        own, other = ds[name].values, expected[name]
        if own.dtype.kind == "U":
            assert list(own) == list(other.astype(object).fillna("")), name
        else:
            np.testing.assert_array_equal(own, other.astype(float), err_msg=name)


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
    for name, own in (("events", found.events), ("dwells", found.stays), ("histogram", found.histogram)):
        same(own, pd.read_csv(files[name], keep_default_na=False, na_values=[""]))
    assert set(found.samples.phase.values) == {"stuck", "slipping", "free"} and found.reached > 10
    assert float(found.histogram.tip_time_s.sum()) == pytest.approx(3)


@pytest.mark.parametrize("model", [False, True])
def test_forces_are_the_programs_table(cone, model):
    expected = table("force", CONE, "--frames", FRAMES, *(["--model"] if model else []))
    same(wm.force(cone, FRAMES, model=model), expected)
    frame = pd.read_csv(FRAMES, comment="#")
    own = wm.force(cone, frame, model=model)
    same(own, expected)
    xr.testing.assert_identical(wm.force(cone, frame.to_dict("list"), model=model), own)
    assert np.nanmax(own.force_un) > 0 and own.reason.dims == ("time_s",)


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
    with pytest.raises(ValueError, match="times must grow"):
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
    with pytest.raises(ValueError, match="must be between -90 and 90"):
        wm.texture(rough, time, 5 * angle)
    for call in (lambda scene: wm.texture(scene, time, angle), lambda scene: wm.force(scene, FRAMES)):
        with pytest.raises(ValueError, match="friction = 0.1: must be 0"):
            call(rough.replace(friction=0.1))
    with pytest.raises(ValueError, match="curvature_per_mm"):
        wm.force(cone, {"time_s": [0.0]})
    with pytest.raises(TypeError, match="frames = 3"):
        wm.force(cone, 3)
