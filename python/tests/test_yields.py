"""Marks of states and pushes beyond the yield strain."""

from __future__ import annotations

import numpy as np
import pytest
import whiskmap as wm

PARTS = {
    "whisker": wm.Whisker(length_mm=20, base_radius_um=30, tip_radius_um=1.5, youngs_modulus_gpa=3, yield_strain=0.002),
    "pole": wm.Pole(radius_mm=0.25),
    "grid": wm.Grid(push_angle_deg=wm.Range(-40, 40, 17), distance_mm=[8, 12, 25]),
}


@pytest.fixture
def scene() -> wm.Scene:
    return wm.Scene(**PARTS)


def test_a_scene_keeps_its_yield_strain(scene: wm.Scene) -> None:
    assert scene.whisker.yield_strain == 0.002
    assert wm.Scene.parse(scene.to_toml()).whisker == scene.whisker
    assert scene.replace(length_mm=21).whisker.yield_strain == 0.002
    assert scene.replace(yield_strain=0.01) != scene
    without = scene.replace(yield_strain=None)
    assert without.whisker.yield_strain is None
    assert "yields" not in wm.curve(without) and "peak_strain" not in wm.map(without)


@pytest.mark.parametrize("strain", [0, -0.01, 1.5, float("nan")])
def test_a_bad_yield_strain_is_refused(scene: wm.Scene, strain: float) -> None:
    with pytest.raises(wm.SceneError, match="must be more than 0 and at most 1"):
        scene.replace(yield_strain=strain)


def test_pushes_and_states_are_marked(scene: wm.Scene) -> None:
    ends = wm.curve(scene)
    assert ends.yields.dtype == bool
    reached = ends.max_strain.notnull()
    assert not reached.sel(distance_mm=25).any() and reached.sel(distance_mm=8).all()
    np.testing.assert_array_equal(ends.yields, ends.max_strain > 0.002)
    assert (ends.max_strain >= ends.peak_strain * (1 - 1e-9)).where(reached, True).all()
    one = wm.detachment(scene, distance_mm=[8, 12, 25], side="both")
    assert one.yields is not None and one.yields.any() and not one.yields.all()
    np.testing.assert_array_equal(one.max_strain, ends.max_strain.T)
    np.testing.assert_array_equal(one.yields, ends.yields.T)
    assert wm.detachment(scene.replace(yield_strain=None), distance_mm=8).yields is None
    branch = wm.branch(scene, 8)
    np.testing.assert_array_equal(branch.yields, branch.peak_strain > 0.002)
    assert branch.yields.any() and not branch.yields.all()
    shape = wm.shape(scene, 8, 30)
    np.testing.assert_array_equal(shape.yields, shape.strain > 0.002)
    assert shape.yields.any()


def test_samples_have_the_strains_of_their_states(scene: wm.Scene) -> None:
    course = wm.whisk(scene, 8, [0, 1, 2], [-1, 10, 30])
    pushed = [wm.branch(scene, 8, points=3), *(wm.shape(scene, 8, push) for push in (10, 30))][1:]
    strains = [float(own.strain.max()) for own in pushed]
    assert course.samples.peak_strain[0] == 0
    # Points of a shape miss the largest strain by 1e-4.
    np.testing.assert_allclose(course.samples.peak_strain[1:], strains, rtol=1e-3)
    np.testing.assert_array_equal(course.samples.yields, [False, False, True])


def test_forces_of_the_model_have_the_strains_of_their_states(scene: wm.Scene) -> None:
    pushed = wm.shape(scene.replace(pole_radius_mm=None), 8, 30)
    contact = int(np.flatnonzero(pushed.part == "contact")[0])
    turn = np.radians(30) * np.array([1, 1])
    x, y = (float(pushed[own][contact]) for own in ("x_mm", "y_mm"))
    (cos, _), (sin, _) = np.cos(turn), np.sin(turn)
    frames = {
        "time_s": [0.0, 0.1],
        "curvature_per_mm": [0.0, float(pushed.curvature_per_mm[20])],
        "at_arc_length_mm": [2.0, float(pushed.arc_length_mm[20])],
        "contact_x_mm": [None, cos * x - sin * y],
        "contact_y_mm": [None, sin * x + cos * y],
    }
    found = wm.force(scene.replace(pole_radius_mm=None), frames, model=True)
    np.testing.assert_allclose(found.peak_strain, [0, float(pushed.strain.max())], rtol=1e-3)
    np.testing.assert_array_equal(found.yields, [False, True])
    assert "yields" not in wm.force(scene.replace(yield_strain=None), frames, model=True)


def test_maps_have_strains(scene: wm.Scene) -> None:
    found = wm.map(scene)
    lazy = wm.map(scene, lazy=True)
    np.testing.assert_array_equal(found.peak_strain, lazy.peak_strain)
    np.testing.assert_array_equal(found.peak_strain.isnull(), found.force_un.isnull())
    assert len(found.peak_strain.attrs["long_name"].split()) <= 6
    asked = wm.map(scene.replace(yield_strain=None), channels=["regime", "peak_strain"])
    np.testing.assert_array_equal(asked.peak_strain, found.peak_strain)


def test_a_design_that_yields_is_warned_of(scene: wm.Scene) -> None:
    with pytest.warns(wm.SceneWarning, match=r"taper = 0\.\d+: the whisker yields: the largest strain of the push, 0\.\d+, exceeds"):
        wm.design(scene, "taper", distance_mm=8, slip_off_deg=60)


def test_rows_of_a_table_have_their_own_yield_strains(scene: wm.Scene) -> None:
    table = [{"name": "unknown", "yield_strain": None}, {"name": "soft", "yield_strain": 0.002}, {"name": "strong", "yield_strain": 0.9}]
    pad = scene.replace(yield_strain=None, table=table)
    assert pad.table == table
    assert "peak_strain" in wm.map(pad)
    ends = wm.curve(pad).sel(distance_mm=8)
    assert not ends.yields.sel(whisker=["unknown", "strong"]).any() and ends.yields.sel(whisker="soft").all()
    np.testing.assert_array_equal(ends.max_strain.sel(whisker="soft"), wm.curve(scene).max_strain.sel(distance_mm=8))
    assert pad.select("soft").whisker.yield_strain == 0.002
    assert pad.select("unknown").whisker.yield_strain is None
    assert pad.replace(length_mm=21).table == table
    for strain in (None, 0.9):
        one = scene.replace(yield_strain=strain).replace(table=[table[1]])
        assert wm.detachment(one, distance_mm=[8.0], side="cb").yields.all()
    with pytest.raises(wm.SceneError, match="must be left out: whiskers.table has the column yield_strain"):
        pad.replace(yield_strain=0.01)
