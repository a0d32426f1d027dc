"""Maps in memory and stored ones, against those that the program writes."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from conftest import program

import whiskmap as wm


def sweep_of(small: wm.Scene) -> wm.Scene:
    return small.replace(taper=[0.5, 0.95, 1], curvature_per_mm=[0.0, 0.02], friction=0.2)


@pytest.fixture(scope="module")
def stored(small, tmp_path_factory):
    """A sweep as an EXR map and as a store."""
    folder = tmp_path_factory.mktemp("stored")
    path = folder / "sweep.toml"
    path.write_text(sweep_of(small).replace(name="sweep").to_toml())
    program("map", path, "-o", folder, "--engine", "cpu", "--no-png")
    program("map", path, "-o", folder, "--engine", "cpu", "--format", "zarr")
    return folder


def test_a_map_is_the_programs_store(small, stored):
    store = xr.open_zarr(stored / "sweep.zarr", mask_and_scale=False)
    ds = wm.map(sweep_of(small), engine="cpu")
    assert ds.sizes == {"taper": 3, "curvature_per_mm": 2, "distance_mm": 16, "push_angle_deg": 24}
    for name, variable in ds.variables.items():
        other = store.variables[name]
        np.testing.assert_array_equal(variable.values, other.values, err_msg=name)
        assert (variable.dims, variable.dtype) == (other.dims, other.dtype)
        assert variable.attrs == {key: other.attrs[key] for key in variable.attrs}
    for name in ("engine", "arithmetic", "whiskmap_version", "Conventions"):
        assert ds.attrs[name] == store.attrs[name]


@pytest.mark.parametrize("name", ["sweep.exr", "sweep.zarr"])
@pytest.mark.parametrize("chunks", [None, {}])
def test_stored_maps_open_lazily(small, stored, name, chunks):
    ds = wm.map(sweep_of(small), engine="cpu")
    opened = xr.open_dataset(stored / name, engine="whiskmap", chunks=chunks)
    assert opened.attrs["scene"] == sweep_of(small).replace(name="sweep").to_toml()
    part = {"taper": [2, 0], "curvature_per_mm": 1, "distance_mm": slice(None, None, -3), "push_angle_deg": [5, 1]}
    xr.testing.assert_equal(opened.isel(part), ds.isel(part))
    xr.testing.assert_equal(opened, ds)
    xr.testing.assert_equal(opened.force_un.sel(taper=0.95).max("curvature_per_mm"), ds.force_un.sel(taper=0.95).max("curvature_per_mm"))
    assert wm.open(stored / name, chunks=chunks).regime.attrs["flag_meanings"].startswith("out_of_reach")


def test_an_open_file_may_be_moved(stored):
    whole = wm.open(stored / "sweep.exr").force_un.load()
    opened = wm.open(stored / "sweep.exr")
    (stored / "sweep.exr").rename(stored / "moved.exr")
    (stored / "sweep.exr").write_text("another file")
    xr.testing.assert_equal(opened.force_un.isel(taper=0, curvature_per_mm=1), whole.isel(taper=0, curvature_per_mm=1))
    (stored / "moved.exr").rename(stored / "sweep.exr")


def test_unfinished_stores_have_fill_values(small, tmp_path):
    path = tmp_path / "part.toml"
    path.write_text(sweep_of(small).replace(name="part", taper=list(np.linspace(0, 1, 40))).to_toml())
    program("map", path, "-o", tmp_path, "--engine", "cpu", "--format", "zarr", "--shard", "0/2")
    ds = wm.open(tmp_path / "part.zarr")
    is_missing = ds.regime == 254
    assert 0 < is_missing.sum() < ds.regime.size and ds.force_un.where(is_missing).isnull().all()


def test_the_array_owns_the_memory_of_rust(small):
    force = wm.map(small).force_un.values
    while isinstance(force.base, np.ndarray):
        force = force.base
    assert type(force.base).__name__ == "PySliceContainer"


def test_channels_engines_and_threads(small):
    ds = wm.map(small, channels=["regime", "force_un"], engine="cpu", threads=1)
    assert list(ds) == ["regime", "force_un"] and ds.attrs["engine"] == "cpu f64"
    xr.testing.assert_identical(wm.map(small, channels=["regime", "force_un"], engine="cpu", threads=2), ds)
    assert wm.map(small, engine="spectral", tolerance_deg=1e-3).attrs["engine"] == "spectral f64"
    seen = []
    wm.map(small, progress=lambda done, cells: seen.append((done, cells)))
    assert seen[-1] == (384, 384) and sorted(seen) == seen


def test_plans_compute_nothing(cone):
    plan = wm.plan(cone)
    assert (plan.whiskers, plan.cells) == (1, 512 * 512) and "curvature" in plan.effects
    large = cone.replace(taper=wm.Range(0, 1, 65536))
    assert wm.plan(large).memory_bytes is None
    with pytest.raises(MemoryError, match="lower the counts of the axes"):
        wm.map(large)


@pytest.mark.parametrize("lazy", [False, True])
def test_a_derivative_that_the_scene_lacks_is_bad_input(small, lazy):
    with pytest.raises(ValueError, match="d_push_d_friction has no values"):
        wm.map(small, channels=["d_push_d_friction"], lazy=lazy)
