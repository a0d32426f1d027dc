"""Marks of states and pushes beyond the yield strain."""

from __future__ import annotations

import numpy as np
import pytest
import whiskmap as wm
from test_motion import FRAMES

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


def test_pushes_and_states_are_marked(scene: wm.Scene, cone: wm.Scene) -> None:
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
    forces = wm.force(cone.replace(yield_strain=0.002), FRAMES, model=True)
    for samples in (wm.whisk(scene, 8, [0, 1, 2], [-1, 10, 30]).samples, forces):
        assert samples.yields.dtype == bool and samples.peak_strain.notnull().any()
        np.testing.assert_array_equal(samples.yields, samples.peak_strain > 0.002)


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
