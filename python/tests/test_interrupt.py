"""Ctrl-C ends every call soon: a computation looks at signals while it runs."""

from __future__ import annotations

import subprocess
import sys

import pytest
from conftest import ROOT

# Statements that make the arguments `prepared`, and the call that is interrupted. Each call takes many seconds.
CALLS = {
    "map": ("scene = cone.replace(taper=wm.Range(0, 1, 200))", "wm.map(scene, engine='cpu')"),
    # One group of whiskers, whose rows are followed by continuation.
    "map of soft mounts": (
        "soft = cone.replace(taper=wm.Range(0, 0.9, 64), follicle_stiffness_nnm_per_rad=100,"
        " distance_mm=wm.Range(3, 19, 4000), push_angle_deg=[20.0])",
        "wm.map(soft, engine='cpu')",
    ),
    "lazy map": ("ds = wm.map(cone.replace(taper=wm.Range(0, 1, 200)), engine='cpu', lazy=True)", "ds.force_un.load()"),
    "curve of many whiskers": ("scene = cone.replace(taper=wm.Range(0, 1, 9000))", "wm.curve(scene)"),
    "curve of many distances": (
        "scene = cone.replace(distance_mm=wm.Range(2, 19.9, 65536), friction=0.3)",
        "[wm.curve(scene) for _ in range(20)]",
    ),
    "detachment": ("taper = np.linspace(0, 1, 400_000)", "wm.detachment(cone, distance_mm=15.0, side='cb', taper=taper, jac=['taper'])"),
    "sensitivity": ("", "[wm.sensitivity(cone, np.linspace(2, 19, 4000)) for _ in range(50)]"),
    "branch": ("", "[wm.branch(cone, 15.66, points=1_000_000) for _ in range(9)]"),
    "shape": ("", "[wm.shape(cone, 15.66, 10, points=1_000_000) for _ in range(50)]"),
    "whisk": ("t = np.arange(1_000_000) / 1000; a = 40 * np.sin(2 * np.pi * 10 * t)", "wm.whisk(cone, 15.66, t, a)"),
    "whisk with friction": (
        "t = np.arange(1_000_000) / 1000; a = 40 * np.sin(2 * np.pi * 10 * t); rough = cone.replace(friction=0.3)",
        "wm.whisk(rough, 15.66, t, a)",
    ),
    "texture": (
        "rough = wm.Scene.read(sys.argv[1] + '/scenes/texture_cone.toml'); t = np.arange(1_000_000) / 1000; a = 15 * np.sin(t)",
        "wm.texture(rough, t, a)",
    ),
    "read_tracking": (
        "import tempfile; head, rows = open(sys.argv[1] + '/scenes/deeplabcut.csv').read().split('\\n0,');"
        " rows = [row.partition(',')[2] for row in ('0,' + rows).splitlines()] * 1800;"
        " film = tempfile.NamedTemporaryFile('w', suffix='.csv');"
        " film.write('\\n'.join([head, *(f'{i},{row}' for i, row in enumerate(rows))])); film.flush()",
        "wm.read_tracking(film.name, mm_per_pixel=0.05, fps=500, pole='pole', contact_within_mm=0.35)",
    ),
    "force of the model": (
        "f = pd.read_csv(sys.argv[1] + '/scenes/frames.csv', comment='#'); f = pd.concat([f] * 400, ignore_index=True);"
        " f['time_s'] = np.arange(len(f))",
        "wm.force(cone, f, model=True)",
    ),
    "fit": (
        "rng = np.random.default_rng(1); n = 400; p = {'side': ['cb'] * n, 'distance_mm': rng.uniform(3, 19, n),"
        " 'push_angle_deg': rng.uniform(1, 90, n)}",
        "wm.fit(cone, p, ['tip_radius_um', 'parabola_per_mm', 'base_radius_um', 'length_mm', 'pole_radius_mm'])",
    ),
    "design": ("", "[wm.design(cone, 'taper', distance_mm=15.0, side='cb', max_force_un=5) for _ in range(99)]"),
    "scene of traced points": (
        "x = np.linspace(0, 15, 8000); xy = np.c_[x, 0.02 * x**2 + 0.1 * np.sin(3 * x)]",
        "[cone.replace(parabola_per_mm=None, vertex_mm=None, rest_points=xy) for _ in range(99)]",
    ),
}

SCRIPT = """
import os, signal, sys, threading, time
import numpy as np
import pandas as pd
import whiskmap as wm
signal.signal(signal.SIGINT, signal.default_int_handler)
cone = wm.Scene.read(sys.argv[1] + "/scenes/cone.toml")
{prepared}
wm.curve(cone.replace(distance_mm=[9.0]))
try:
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        {call}
    finally:
        ended = time.monotonic()
except KeyboardInterrupt:
    print("interrupted", ended, flush=True)
"""


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_ends_the_call(name):
    prepared, call = CALLS[name]
    command = [sys.executable, "-c", SCRIPT.format(prepared=prepared, call=call), str(ROOT)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert run.stdout.startswith("interrupted") and run.returncode == 0, run.stderr
