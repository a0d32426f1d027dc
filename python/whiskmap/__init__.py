"""Mechanics of whiskers that are pushed against a pole.

A scene describes a whisker at rest, a pole and a grid, as a scene file of the program does. Units are those of the names:
`length_mm`, `base_radius_um`, `push_angle_deg`, `force_un`, `base_moment_nnm`.

>>> import whiskmap as wm
>>> scene = wm.Scene(
...     whisker=wm.Whisker(
...         length_mm=20, base_radius_um=30, taper=0.95, youngs_modulus_gpa=3, parabola_per_mm=0.02
...     ),
...     pole=wm.Pole(radius_mm=0.25),
...     grid=wm.Grid(push_angle_deg=wm.Range(-70, 70, 64), distance_mm=[10, 15.66]),
... )
>>> ds = wm.map(scene)
>>> ds.force_un.dims
('distance_mm', 'push_angle_deg')
>>> float(wm.curve(scene).push_angle_deg.sel(side="cb", distance_mm=15.66).round(4))
15.6079

The mechanics are those of Hires, Pammer, Svoboda and Golomb (2013), eLife 2:e01350.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from whiskmap._parts import Grid, Pole, Range, Surface, Whisker
from whiskmap._scene import Scene
from whiskmap._warnings import SceneWarning
from whiskmap._whiskmap import SceneError, StateError, version

if TYPE_CHECKING:
    from whiskmap import plot as plot
    from whiskmap._detachment import Detachment as Detachment
    from whiskmap._detachment import detachment as detachment
    from whiskmap._fits import Design as Design
    from whiskmap._fits import Fit as Fit
    from whiskmap._fits import design as design
    from whiskmap._fits import fit as fit
    from whiskmap._locate import locate as locate
    from whiskmap._maps import Plan as Plan
    from whiskmap._maps import map as map
    from whiskmap._maps import plan as plan
    from whiskmap._motion import Texture as Texture
    from whiskmap._motion import Whisk as Whisk
    from whiskmap._motion import force as force
    from whiskmap._motion import texture as texture
    from whiskmap._motion import whisk as whisk
    from whiskmap._stored import open as open
    from whiskmap._traces import branch as branch
    from whiskmap._traces import curve as curve
    from whiskmap._traces import sensitivity as sensitivity
    from whiskmap._traces import shape as shape
    from whiskmap._tracking import Tracking as Tracking
    from whiskmap._tracking import read_tracking as read_tracking

__version__ = version()

# `map` and `open` would hide those of Python.
__all__ = ["Grid", "Pole", "Range", "Scene", "SceneError", "SceneWarning", "StateError", "Surface", "Whisker"]

# numpy and xarray are imported when a function is first used.
_MODULES = {
    "Design": "_fits",
    "Detachment": "_detachment",
    "Fit": "_fits",
    "Plan": "_maps",
    "Texture": "_motion",
    "Tracking": "_tracking",
    "Whisk": "_motion",
    "branch": "_traces",
    "curve": "_traces",
    "design": "_fits",
    "detachment": "_detachment",
    "fit": "_fits",
    "force": "_motion",
    "locate": "_locate",
    "map": "_maps",
    "open": "_stored",
    "plan": "_maps",
    "plot": "plot",
    "read_tracking": "_tracking",
    "sensitivity": "_traces",
    "shape": "_traces",
    "texture": "_motion",
    "whisk": "_motion",
}


def __getattr__(name: str) -> object:
    from importlib import import_module

    if name not in _MODULES:
        raise AttributeError(f"module 'whiskmap' has no attribute {name!r}")
    module = import_module(f"whiskmap.{_MODULES[name]}")
    value = module if name == "plot" else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, *_MODULES, "__version__"])
