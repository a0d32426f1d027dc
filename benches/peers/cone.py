"""The push that solve_bvp and AUTO-07p follow: the whisker of scenes/cone.toml, its convex side (CB) on the pole."""

import sys
import tomllib
from math import radians
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# AUTO's equations and the whisker at rest are those of the comparison in tests/peers.
sys.path.append(str(ROOT / "tests" / "peers"))

from resting import Whisker

SCENE = tomllib.loads((ROOT / "scenes" / "cone.toml").read_text())
WHISKER = Whisker(SCENE, side=1)
# The paper's Fig 2: it slips off after a push of 15.6 degrees.
TOUCH = WHISKER.slope_at_distance(15.66 / WHISKER.length_mm)
AXIS = SCENE["grid"]["push_angle_deg"]
# From one cell of the scene's map to the next.
CELL = radians((AXIS["to"] - AXIS["from"]) / (AXIS["count"] - 1))
