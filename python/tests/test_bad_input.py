"""Bad input: an exception of the right class that names the argument, and never a crash of the interpreter."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import whiskmap as wm

SELF = Path(__file__)


CASES = {
    "broadcast": (ValueError, r"do not broadcast: distance_mm \(2,\), taper \(3,\)", lambda s: wm.detachment(s, taper=[0, 0.5, 1], distance_mm=[1, 2], side="cb")),
    "broadcast to both sides": (ValueError, r"do not broadcast: distance_mm \(2,\), taper \(3,\)$", lambda s: wm.detachment(s, taper=[0, 0.5, 1], distance_mm=[1, 2])),
    "broadcast to sides": (ValueError, r"do not broadcast: distance_mm \(2,\), side \(3,\)$", lambda s: wm.detachment(s, distance_mm=[1, 2], side=["cb"] * 3)),
    "dtype": (TypeError, "taper: must be real numbers", lambda s: wm.detachment(s, taper=[1j], distance_mm=1)),
    "objects": (TypeError, "taper: must be real numbers", lambda s: wm.detachment(s, taper=[None], distance_mm=1)),
    "ragged": (ValueError, "taper", lambda s: wm.detachment(s, taper=[[1], [1, 2]], distance_mm=1)),
    "nan": (ValueError, r"taper\[1\] = nan", lambda s: wm.detachment(s, taper=[0.5, np.nan], distance_mm=1, strict=True)),
    "units": (TypeError, "length_mm = '20 mm'", lambda s: s.replace(length_mm="20 mm")),
    "units of arrays": (TypeError, "length_mm: must be real numbers without a unit", lambda s: wm.detachment(s, length_mm="20 mm", distance_mm=1)),
    "range of an element": (wm.SceneError, r"^taper\[2\] = 1.5: must be between 0 and 1", lambda s: wm.detachment(s, taper=[0, 1, 1.5], distance_mm=9, side="cb", strict=True)),
    "distance": (wm.SceneError, r"^distance_mm\[1\] = 300: must be", lambda s: wm.detachment(s, distance_mm=[15, 300.0], side="cb", strict=True)),
    "range of an element of two dimensions": (wm.SceneError, r"^taper\[1, 0\] = -1: must be", lambda s: wm.detachment(s, taper=[[0.5], [-1]], distance_mm=[[9, 10]], strict=True)),
    "two names of one number": (TypeError, "tip_radius_um and taper: give one of them|taper and tip_radius_um: give one of them", lambda s: s.replace(tip_radius_um=2, taper=0.5)),
    "two names of one axis": (TypeError, "parabola_per_mm and curvature_per_mm|curvature_per_mm and parabola_per_mm", lambda s: s.replace(curvature_per_mm=[0, 0.1], parabola_per_mm=0.02)),
    "side of a branch": (ValueError, "side = 'left': must be one of 'both', 'cb', 'cf'", lambda s: wm.branch(s, 15.0, "left")),
    "side of an array": (ValueError, r"side\[1\] = 'left': must be 'cb' or 'cf'", lambda s: wm.detachment(s, distance_mm=1, side=["cb", "left"])),
    "columns of points": (ValueError, "rest_points: must have the columns x_mm and y_mm, has no y_mm", lambda s: s.replace(rest_points={"x_mm": [0, 1]})),
    "number of a profile": (TypeError, r"profile\['radius_um'\]\[1\] = '3': must be a number", lambda s: s.replace(profile={"arc_length_mm": [0, 1], "radius_um": [3, "3"]})),
    "unknown parameter": (TypeError, "'lenght_mm'; did you mean 'length_mm'", lambda s: wm.detachment(s, lenght_mm=1, distance_mm=1)),
    "name of an axis": (TypeError, "did you mean 'parabola_per_mm'", lambda s: wm.detachment(s, curvature_per_mm=1, distance_mm=1)),
    "unknown change": (TypeError, "'lenght_mm'; did you mean 'length_mm'", lambda s: s.replace(lenght_mm=1)),
    "unknown variable": (ValueError, "jac = 'tapr'.*did you mean `taper`", lambda s: wm.detachment(s, distance_mm=1, jac=["tapr"])),
    "side": (ValueError, "side = 'left'", lambda s: wm.detachment(s, distance_mm=1, side="left")),
    "missing": (wm.SceneError, "whisker.base_radius_um: is left out", lambda s: wm.detachment(distance_mm=1, taper=0.5)),
    "scene": (TypeError, "scene = 3: must be a Scene", lambda s: wm.map(3)),
    "engine": (ValueError, "engine = 'fast'", lambda s: wm.map(s, engine="fast")),
    "channels": (ValueError, "^channels = 'force': must be a list of names out of regime, .*; did you mean 'force_un'", lambda s: wm.map(s, channels=["force"])),
    "channels of a lazy map": (ValueError, "^channels = 'force': must be a list", lambda s: wm.map(s, channels=["force"], lazy=True)),
    "channels with a comma": (ValueError, "^channels = 'regime,force_un': must be a list", lambda s: wm.map(s, channels=["regime,force_un"])),
    "no channels": (ValueError, r"^channels = \[\]: must have at least one name", lambda s: wm.map(s, channels=[])),
    "number as a channel": (TypeError, r"^channels = \[3\]: must be a list of names", lambda s: wm.map(s, channels=[3])),
    "negative count": (ValueError, "^count = -3: must be at least 1", lambda s: wm.Range(1, 2, -3)),
    "count with a fraction": (TypeError, "^count = 2.5: must be a whole number", lambda s: wm.Range(1, 2, 2.5)),
    "tolerance": (ValueError, "tolerance_deg = -1", lambda s: wm.map(s, tolerance_deg=-1.0)),
    "large tolerance": (ValueError, "^tolerance_deg = 1000000: must be between 1e-10 and 1$", lambda s: wm.curve(s, tolerance_deg=1e6)),
    "threads": (ValueError, "^threads = 0: must be a whole number between 1 and 1024", lambda s: wm.map(s, threads=0)),
    "negative threads": (ValueError, "threads = -1: must be a whole number between 1", lambda s: wm.map(s, threads=-1)),
    "huge threads": (ValueError, "threads = 1000000000000000000000", lambda s: wm.detachment(s, distance_mm=9, threads=10**21)),
    "threads as a text": (TypeError, "^threads = '2': must be a whole number", lambda s: wm.map(s, threads="2")),
    "threads with a fraction": (TypeError, "^threads = 1.5: must be a whole number between 1 and 1024", lambda s: wm.curve(s, threads=1.5)),
    "threads of a lazy map": (TypeError, "^threads = 1.5: must be a whole number", lambda s: wm.map(s, threads=1.5, lazy=True)),
    "threads of a truth": (TypeError, "^threads = True: must be a whole number", lambda s: wm.detachment(s, distance_mm=9, threads=True)),
    "masked": (ValueError, "taper: has masked values", lambda s: wm.detachment(s, taper=np.ma.masked_less([0.1, 0.9], 0.5), distance_mm=1)),
    "points": (ValueError, "^points = 2: must be a whole number between 3 and 1000000", lambda s: wm.branch(s, 15.0, points=2)),
    "points of a shape": (ValueError, "^points = 1: must be a whole number between 2 and 1000000", lambda s: wm.shape(s, 15.0, 5, points=1)),
    "negative points": (ValueError, "^points = -1: must be a whole number between 3", lambda s: wm.branch(s, 15.0, points=-1)),
    "points with a fraction": (TypeError, "^points = 10.5: must be a whole number between 3 and 1000000", lambda s: wm.branch(s, 15.0, points=10.5)),
    "points of a shape with a fraction": (TypeError, "^points = 10.5: must be a whole number between 2", lambda s: wm.shape(s, 15.0, 5, points=10.5)),
    "push": (ValueError, "push_angle_deg = NaN", lambda s: wm.shape(s, 15.0, float("nan"))),
    "pole": (wm.SceneError, "distance_mm", lambda s: wm.branch(s, -15.0)),
    "sweep": (ValueError, "scene: sweeps 2 whiskers along taper", lambda s: wm.branch(s.replace(taper=[0, 1]), 15.0)),
    "axis": (wm.SceneError, r"grid.distance_mm\[1\] = 2: must be greater", lambda s: s.replace(distance_mm=[3, 2])),
    "axis of two dimensions": (ValueError, "distance_mm: must have one dimension, has 2", lambda s: s.replace(distance_mm=np.ones((2, 2)))),
    "sweep axis": (ValueError, "grid.sweep = 'youngs_modulus_gpa'", lambda s: wm.Scene(whisker=s.whisker, grid=wm.Grid(push_angle_deg=[0], distance_mm=[9], sweep={"youngs_modulus_gpa": [1, 2]}))),
    "whisker": (TypeError, "whisker = 3: must be a Whisker", lambda s: wm.Scene(whisker=3, grid=s.grid)),
    "fit columns": (ValueError, "columns must be equally long", lambda s: wm.fit(s, {"side": ["cb"], "distance_mm": [1, 2]}, ["taper"])),
    "fit side": (ValueError, r"^points\[0\]: side = left", lambda s: wm.fit(s, {"side": ["left"], "distance_mm": [9], "push_angle_deg": [9]}, ["taper"])),
    "fit free": (ValueError, "free = 'tapr'", lambda s: wm.fit(s, {"side": ["cb"], "distance_mm": [9], "push_angle_deg": [9]}, ["tapr"])),
    "two targets": (TypeError, "exactly one of", lambda s: wm.design(s, "taper", distance_mm=9, slip_off_deg=9, pull_off_deg=9)),
    "target": (ValueError, "must be negative with side='cf'|must be positive", lambda s: wm.design(s, "taper", distance_mm=9, slip_off_deg=9, side="cf")),
    "target that is no number": (ValueError, "^slip_off_deg = NaN: must be between -3240 and 3240", lambda s: wm.design(s, "taper", distance_mm=9, slip_off_deg=np.nan)),
    "negative load": (ValueError, "^max_force_un = -5: must be more than 0", lambda s: wm.design(s, "taper", distance_mm=9, side="cb", max_force_un=-5)),
    "negative one of two loads": (ValueError, "^max_strain = -1: must be more than 0", lambda s: wm.design(s, ["taper", "base_radius_um"], distance_mm=9, side="cb", max_force_un=5, max_strain=-1)),
    "folder": (IsADirectoryError, "tests", lambda s: wm.Scene.read(SELF.parent)),
    "file": (FileNotFoundError, "nowhere.exr", lambda s: wm.open("nowhere.exr")),
    "foreign file": (ValueError, "is not an EXR file", lambda s: wm.open(str(SELF))),
    "foreign folder": (ValueError, "is not a store", lambda s: wm.open(str(SELF.parent))),
}


@pytest.mark.parametrize("name", CASES)
def test_bad_input_is_named(cone, name):
    kind, message, call = CASES[name]
    with pytest.raises(kind, match=message) as refused:
        call(cone)
    assert type(pickle.loads(pickle.dumps(refused.value))) is type(refused.value)


def test_random_calls_do_not_crash_the_interpreter():
    done = subprocess.run([sys.executable, SELF], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    calls, refused = map(int, done.stdout.split())
    assert calls == 10_000 and 1_000 < refused < 10_000


def random_calls() -> None:
    """Call functions 10,000 times with random arguments; an exception must be an ordinary one."""
    rng = np.random.default_rng(0)
    cone = wm.Scene.read(SELF.parents[2] / "scenes/cone.toml").replace(push_angle_deg=[-5, 5], distance_mm=[9, 15])
    values = [
        0, -1, 0.5, 15.0, 1e300, -1e-300, float("nan"), float("inf"), 2**70, True, None, "20 mm", "cb", b"cb", 1j, [], [0.5], [0, 1],
        [[0.1], [0.2]], {}, {"taper": 1}, np.zeros((2, 0)), np.array(0.9), np.array([0.5, 0.9]), np.array(["cb", "cf"]),
        np.float32(0.3), np.array([1, 2], dtype=object), wm.Range(0, 1, 3), wm.Range(1, 0, 10**12), cone, cone.whisker, cone.grid,
        object(), float, "\0", "x" * 10_000, "/", ["regime"], ["taper"], range(5),
    ]  # fmt: skip
    names = [*"distance_mm side jac threads engine tolerance_deg channels progress points stable free title name profile".split()]
    names += ["push_angle_deg", "sweep", "whisker", "grid", "pole", "uncertainty", "slip_off_deg", "max_strain"]
    names += list(wm._description.PARAMETERS)
    functions = [wm.map, wm.curve, wm.branch, wm.shape, wm.fit, wm.design, wm.detachment, wm.sensitivity, wm.plan, wm.open]
    functions += [cone.replace, wm.Scene, wm.Whisker, wm.Pole, wm.Grid, wm.Scene.parse, wm.Scene.read]
    core = [getattr(wm._whiskmap, name) for name in dir(wm._whiskmap) if name not in ("run_command",) and not name.startswith("_")]
    refused = 0
    for _ in range(10_000):
        function = rng.choice(np.array(functions + core, dtype=object))
        pick = lambda: values[rng.integers(len(values))]  # noqa: E731
        positional = [cone] * int(rng.random() < 0.7) + [pick() for _ in range(rng.integers(3))]
        named = {names[rng.integers(len(names))]: pick() for _ in range(rng.integers(3))}
        try:
            function(*positional, **named)
        except Exception:
            refused += 1
    print(10_000, refused)


if __name__ == "__main__":
    random_calls()
