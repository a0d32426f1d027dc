"""Measure the Python package: `python python/benches/table.py`, with a release build installed. Prints medians."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.optimize import least_squares

import whiskmap as wm

ROOT = Path(__file__).resolve().parents[2]


def median(call: Callable[[], object], rounds: int = 7) -> float:
    """Return the median time of a call in ms, after a first one."""
    call()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        times.append(1e3 * (time.perf_counter() - start))
    return statistics.median(times)


def main() -> None:
    """Print a line for each row of the table."""
    cone = wm.Scene.read(ROOT / "scenes/cone.toml")
    names = [None]
    print(f"map, cone 512 x 512: {median(lambda: wm.map(cone)):.1f} ms in Python,", end=" ")
    print(f"{median(lambda: wm._whiskmap.map(cone._checked, 'auto', None, None, None, *names)):.1f} ms in the extension")
    rng, count = np.random.default_rng(0), 10_000
    limits = dict(taper=(0.5, 1), parabola_per_mm=(0, 0.02), base_radius_um=(25, 35), length_mm=(18, 22), pole_radius_mm=(0.1, 0.4))
    whiskers = {name: rng.uniform(low, high, count) for name, (low, high) in limits.items()}
    distances = rng.uniform(8, 16, count)
    for jac in (False, True):
        taken = median(
            lambda: wm.detachment(
                distance_mm=distances, youngs_modulus_gpa=3, threads=1, jac=tuple(whiskers) if jac else False, **whiskers
            ),
            rounds=1,
        )
        print(f"10,000 whiskers, two sides, one thread, {5 if jac else 0} derivatives: {taken:.0f} ms")
    points = pd.read_csv(ROOT / "scenes/cone_points.csv", comment="#")
    fitted = ("tip_radius_um", "parabola_per_mm", "vertex_mm", "pole_radius_mm", "length_mm")
    sides, at = points.side.to_numpy(), points.distance_mm.to_numpy()
    measured, calls = points.push_angle_deg.to_numpy(), []

    def end(x: np.ndarray) -> wm.Detachment:
        calls.append(None)
        return wm.detachment(cone, distance_mm=at, side=sides, jac=True, **dict(zip(fitted, x)))

    bounds = ([0.1, 0, -5, 0.01, 19.8], [10, 0.04, 5, 1, 25])
    start, scale = [1.5, 0.02, 0, 0.25, 20], [1, 0.01, 1, 0.1, 1]

    def fit() -> object:
        last: list[tuple[bytes, wm.Detachment]] = []

        def once(x: np.ndarray) -> wm.Detachment:
            if not last or last[0][0] != x.tobytes():
                last[:] = [(x.tobytes(), end(x))]
            return last[0][1]

        return least_squares(
            lambda x: once(x).push_angle_deg - measured,
            start,
            jac=lambda x: once(x).jac["push_angle_deg"],
            bounds=bounds,
            x_scale=scale,
            ftol=1e-6,
        )

    taken = median(fit)
    print(f"least_squares, 5 parameters, 29 points: {taken:.1f} ms, {len(calls) / 8:.0f} calls")
    code = "import time; t = time.perf_counter(); import whiskmap; print(time.perf_counter() - t)"
    imports = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout) for _ in range(9)]
    print(f"import whiskmap: {1e3 * statistics.median(imports):.0f} ms")


if __name__ == "__main__":
    main()
