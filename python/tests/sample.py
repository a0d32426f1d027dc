"""A sample that `mypy --strict` accepts."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import whiskmap as wm


def largest_force(taper: float) -> float:
    """Return the largest force of a whisker."""
    whisker = wm.Whisker(length_mm=20, base_radius_um=30, taper=taper, youngs_modulus_gpa=3)
    grid = wm.Grid(push_angle_deg=wm.Range(-70, 70, 8), distance_mm=np.linspace(5, 15, 4))
    ds: xr.Dataset = wm.map(wm.Scene(whisker=whisker, grid=grid), channels=["force_un"])
    lazy: xr.Dataset = wm.map(wm.Scene(whisker=whisker, grid=grid), lazy=True, chunks=None)
    return float(max(ds.force_un.max(), lazy.force_un.max()))


def jacobian(scene: wm.Scene, tapers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the derivatives of push angles by the taper."""
    end: wm.Detachment = wm.detachment(scene, distance_mm=15.0, side="cb", taper=tapers, jac=True)
    return end.jac["push_angle_deg"][..., 0]


print(largest_force(0.9))
