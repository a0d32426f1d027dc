"""The push that solve_bvp and AUTO-07p compute: the whisker of scenes/cone.toml, convex side (CB) on the pole."""

import sys
import tomllib
from math import radians
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# The comparison in tests/peers defines AUTO's equations and the whisker at rest.
sys.path.append(str(ROOT / "tests" / "peers"))

from resting import Whisker

SCENE = tomllib.loads((ROOT / "scenes" / "cone.toml").read_text())
WHISKER = Whisker(SCENE, side=1)
# First touch in the paper's Fig. 2, with slip-off after a push of 15.6 degrees.
TOUCH = WHISKER.slope_at_distance(15.66 / WHISKER.length_mm)
AXIS = SCENE["grid"]["push_angle_deg"]
# Push angle between neighbouring cells of the scene's map, in radians.
CELL = radians((AXIS["to"] - AXIS["from"]) / (AXIS["count"] - 1))
