"""The package in a process: imports, threads, forks, signals and memory."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import pickle
import resource
import signal
import subprocess
import sys

import pytest
import xarray as xr

import whiskmap as wm


def test_an_import_loads_neither_numpy_nor_xarray():
    code = "import sys, whiskmap; print([name for name in ('numpy', 'xarray', 'pandas', 'matplotlib') if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"


def test_calls_from_several_threads_are_independent(small):
    scenes = [small.replace(taper=taper) for taper in (0.3, 0.6, 0.9, 0.95)] * 4
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        maps = list(pool.map(wm.map, scenes))
    for scene, ds in zip(scenes, maps):
        xr.testing.assert_identical(ds, wm.map(scene))


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork")
def test_a_forked_process_computes(small):
    wm.curve(small)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map_async(wm.curve, [small, small]).get(timeout=60)
    xr.testing.assert_identical(found[0], wm.curve(small))


def test_ctrl_c_ends_a_long_map():
    code = """
import signal, sys, whiskmap as wm
signal.signal(signal.SIGINT, signal.default_int_handler)
scene = wm.Scene.read(sys.argv[1]).replace(taper=wm.Range(0, 1, 60), push_angle_deg=wm.Range(-70, 70, 600))
said = False
def progress(done, cells):
    global said
    if done and not said:
        said = print("begun", flush=True) is None
try:
    wm.map(scene, engine="cpu", progress=progress)
except KeyboardInterrupt:
    ds = wm.curve(scene.replace(taper=0.5))
    print("interrupted", ds.sizes["distance_mm"])
"""
    from conftest import ROOT

    command = [sys.executable, "-c", code, str(ROOT / "scenes/cone.toml")]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "interrupted 512\n" and process.returncode == 0


def test_an_exception_of_progress_ends_the_map(cone):
    def progress(done, cells):
        raise LookupError("from progress")

    with pytest.raises(LookupError, match="from progress"):
        wm.map(cone, engine="cpu", progress=progress)


def test_memory_does_not_grow_over_1000_maps(small):
    def grown(count):
        for _ in range(count):
            wm.map(small)
            wm.detachment(small, distance_mm=[12, 15], jac=["taper"])
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = grown(200)
    # A leak of one channel of a map would take 1,200 KiB.
    assert grown(800) - before < 1024


def test_pickled_backends_open_in_other_processes(small, tmp_path):
    from conftest import program

    path = tmp_path / "small.toml"
    path.write_text(small.replace(name="small").to_toml())
    program("map", path, "-o", tmp_path, "--no-png")
    ds = wm.open(tmp_path / "small.exr", chunks={})
    xr.testing.assert_equal(pickle.loads(pickle.dumps(ds)).compute(), ds.compute())


def test_the_command_is_the_program(tmp_path):
    script = os.path.join(os.path.dirname(sys.executable), "whiskmap")
    for command in ([sys.executable, "-m", "whiskmap"], [script]):
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, cwd=tmp_path)
        assert (done.returncode, done.stdout) == (0, f"whiskmap {wm.__version__}\n")
        refused = subprocess.run([*command, "map", "nowhere.toml"], capture_output=True, text=True, cwd=tmp_path)
        assert refused.returncode == 2 and refused.stderr.startswith("error: nowhere.toml: cannot be read")
