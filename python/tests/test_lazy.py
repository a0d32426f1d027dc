"""Maps that are computed when they are used, against those that are computed at once."""

from __future__ import annotations

import concurrent.futures
import gc
import multiprocessing
import pickle

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT

import whiskmap as wm
from whiskmap import _lazy


@pytest.fixture(scope="module")
def sweep(small: wm.Scene) -> wm.Scene:
    return small.replace(taper=[0.5, 0.95, 1], curvature_per_mm=[0.0, 0.02], friction=0.2)


@pytest.fixture(scope="module")
def eager(sweep: wm.Scene) -> xr.Dataset:
    return wm.map(sweep, engine="cpu")


PARTS = [
    {},
    {"taper": 1, "curvature_per_mm": 0, "distance_mm": 3, "push_angle_deg": 5},
    {"taper": [2, 0, 2], "curvature_per_mm": 1, "distance_mm": slice(None, None, -3), "push_angle_deg": [5, 1]},
    {"taper": slice(0, 0)},
    {"distance_mm": slice(2, 2), "push_angle_deg": -1},
    {"taper": xr.DataArray([0, 1, 2], dims="cell"), "distance_mm": xr.DataArray([3, 4, 5], dims="cell")},
]


@pytest.mark.parametrize("part", PARTS, ids=range(len(PARTS)))
@pytest.mark.parametrize("chunks", [None, {}, {"taper": 2}], ids=["plain", "whiskers", "chunks"])
def test_the_dataset_is_that_of_a_map(sweep, eager, part, chunks):
    ds = wm.map(sweep, lazy=True, engine="cpu", chunks=chunks).isel(part)
    assert {name: variable.dtype for name, variable in ds.variables.items()} == {name: variable.dtype for name, variable in eager.variables.items()}
    xr.testing.assert_identical(ds.compute(), eager.isel(part))


def test_engines_tolerances_and_channels(cone):
    # A whisker side needs some thousand cells for rows of a net.
    scene = cone.replace(push_angle_deg=wm.Range(-70, 70, 128), distance_mm=wm.Range(2, 20, 96), taper=[0.5, 0.95])
    for options in (
        {"engine": "auto"},
        {"engine": "spectral", "tolerance_deg": 1e-3},
        {"engine": "cpu", "channels": ["force_un", "d_push_d_base_radius_um"], "threads": 1},
    ):
        xr.testing.assert_identical(wm.map(scene, lazy=True, **options).compute(), wm.map(scene, **options))
    assert wm.map(scene, lazy=True, engine="spectral").attrs["engine"] == "spectral f64"


def test_only_the_selected_whiskers_are_computed(small):
    axis = wm.Range(0, 0.9, 1000)
    ds = wm.map(small.replace(taper=axis, friction=axis, pole_radius_mm=axis), lazy=True, engine="cpu")
    assert ds.force_un.size == 1000**3 * 16 * 24
    one = ds.sel(taper=0.9, friction=0.3, pole_radius_mm=0.5, method="nearest")
    at = {name: float(one[name]) for name in ("taper", "friction", "pole_radius_mm")}
    alone = wm.map(small.replace(**at), engine="cpu")
    np.testing.assert_array_equal(one.regime, alone.regime)
    np.testing.assert_allclose(one.force_un, alone.force_un, rtol=1e-6)
    row = ds.force_un.isel(taper=slice(5, 8), friction=-1, pole_radius_mm=[0, 999], distance_mm=4)
    assert row.values.shape == (3, 2, 24)


def test_variables_share_what_is_computed(sweep):
    read = []

    class Counted(_lazy.ComputedMap):
        def read(self, channel, whiskers):
            read.append((channel, tuple(whiskers)))
            return super().read(channel, whiskers)

    ds = Counted(sweep, "cpu", None, ("regime", "force_un"), None).dataset()
    part = ds.isel(taper=2, curvature_per_mm=1).compute()
    # The first sweep axis varies fastest.
    assert sorted(read) == [("force_un", (5,)), ("regime", (5,))]
    assert part.force_un.where(part.regime == 1).notnull().any()


def test_threads_read_one_map(sweep, eager):
    ds = wm.map(sweep, lazy=True, engine="cpu")
    places = [{"taper": taper, "curvature_per_mm": curvature} for taper in range(3) for curvature in range(2)]
    tasks = [(name, place) for place in places for name in ("regime", "force_un", "margin_deg")] * 2
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda task: ds[task[0]].isel(task[1]).values, tasks))
    for (name, place), values in zip(tasks, found):
        np.testing.assert_array_equal(values, eager[name].isel(place))


def test_dask_computes_chunks(sweep, eager):
    ds = wm.map(sweep, lazy=True, engine="cpu", chunks={})
    assert ds.regime.chunks == ((1, 1, 1), (1, 1), (16,), (24,))
    for scheduler in ("threads", "synchronous"):
        xr.testing.assert_identical(ds.compute(scheduler=scheduler), eager)
    strongest = ds.force_un.max(["distance_mm", "push_angle_deg"]).compute(scheduler="threads")
    xr.testing.assert_identical(strongest, eager.force_un.max(["distance_mm", "push_angle_deg"]))
    # Equal maps have equal keys, others do not.
    keys = [wm.map(sweep, lazy=True, engine=engine, chunks={}).force_un.data.name for engine in ("cpu", "cpu", "spectral")]
    assert keys[0] == keys[1] != keys[2]


@pytest.mark.parametrize("chunks", [None, {}], ids=["plain", "whiskers"])
def test_a_pickled_dataset_computes(sweep, eager, chunks):
    ds = wm.map(sweep, lazy=True, engine="cpu", chunks=chunks)
    copy = pickle.loads(pickle.dumps(ds))
    xr.testing.assert_identical(copy.isel(taper=1).compute(), eager.isel(taper=1))
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        far = pool.submit(xr.DataArray.compute, ds.force_un.isel(taper=1)).result(timeout=60)
    xr.testing.assert_identical(far, eager.force_un.isel(taper=1))


def test_variables_that_are_pickled_one_by_one_share_a_map(sweep, monkeypatch):
    ds = wm.map(sweep, lazy=True, engine="cpu", threads=2)
    pickled = [pickle.dumps(ds[name]) for name in ("regime", "force_un")]
    opened = []

    class Counted(_lazy.ComputedMap):
        def __init__(self, *arguments):
            opened.append(arguments)
            super().__init__(*arguments)

    monkeypatch.setattr(_lazy, "ComputedMap", Counted)
    copies = [pickle.loads(data) for data in pickled]
    assert opened == [(sweep, "cpu", None, None, 2)]
    # It is closed with the last variable.
    del copies
    gc.collect()
    assert opened[0] not in _lazy._OPEN


def test_bad_arguments_are_refused(sweep):
    for options, why in (
        ({"progress": True}, "progress = True: must be left out with lazy=True"),
        ({"engine": "fast"}, "engine = 'fast': must be 'auto', 'cpu', 'spectral' or 'gpu'"),
        ({"channels": ["force"]}, "channels = 'force': must be a list of names"),
        ({"tolerance_deg": -1.0}, "tolerance_deg = -1"),
        ({"threads": 0}, "threads = 0: must be a whole number between 1 and 1024"),
    ):
        with pytest.raises(ValueError, match=why):
            wm.map(sweep, lazy=True, **options)
    with pytest.raises(ValueError, match="must be left out without lazy=True"):
        wm.map(sweep, chunks={})
    with pytest.raises(TypeError, match="must be a list of names"):
        wm.map(sweep, lazy=True, channels="force_un")
    with pytest.raises(TypeError, match="must be a Scene"):
        wm.map("scene.toml", lazy=True)
    with pytest.raises(IndexError):
        wm.map(sweep, lazy=True).force_un[7].values


def test_an_engine_without_expansions_is_warned_of():
    measured = wm.Scene.read(ROOT / "scenes/measured.toml").replace(push_angle_deg=[-5, 5], distance_mm=[9, 12])
    with pytest.warns(wm.SceneWarning, match="measured radii has no expansions"):
        wm.map(measured, engine="spectral", lazy=True)
