"""AUTO-07p on the cone: equilibria along one push, and points of the fold curve in two parameters.

    auto_peer.py PROGRAM        tests/peers/auto/whisker.f90, linked with AUTO's objects; prints JSON

The cost of a point is the time of the whole process minus the time of a run that stops after its first point, divided
by the number of further points. Jacobians are exact. Steps have a constant length of about one cell of the map, or one
row on the fold curve. AUTO detects no special points and prints only the last point. Errors are differences of push
angles in radians from a much finer mesh, at given loads and pole distances. AUTO prints push angles with 11 digits.
"""

import json
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from time import perf_counter

from cone import TOUCH, WHISKER
from continuation import ARC, FORCE, LOAD, POLE, PSI, STEP, THETA, Auto

RUNS = 21
MESHES, EXACT_MESH = (10, 20), 80
# Step lengths for 76 equilibria up to the fold, and for 362 folds from a pole at 0.45 of the length to the tip.
EQUILIBRIUM_STEP, FOLD_STEP = 0.023, 0.003
# Load at the fold of this push. The fold curve ends with the contact at the tip and the pole at 0.958 of the length.
LAST_LOAD = 10.4
LOADS = [0.5 * n for n in range(1, 21)]
FOLD_TOUCH, POLES = WHISKER.slope_at_distance(0.45), [0.02 * n for n in range(23, 48)]


class TimedAuto(Auto):
    """AUTO with a number of mesh intervals; `seconds` and `points` belong to the last run."""

    def __init__(self, program, folder, intervals, tolerance):
        super().__init__(program, folder)
        self.common += f"NTST={intervals}\nEPSL={tolerance}\nEPSU={tolerance}\n"

    def _run(self, **constants):
        before = perf_counter()
        labelled = super()._run(**constants)
        self.seconds = perf_counter() - before
        rows = (self.folder / "fort.7").read_text().splitlines()
        # The first column is zero in rows of the header, and the number of the branch in rows of points.
        self.points = sum(row.split()[0] != "0" for row in rows)
        return labelled

    def equilibria(self, **constants):
        """Computes the equilibria from first touch to the fold."""
        free, stop = [THETA, FORCE, ARC, PSI, LOAD], {LOAD: LAST_LOAD}
        steps = {"DS": -EQUILIBRIUM_STEP, "DSMAX": EQUILIBRIUM_STEP}
        self._start(WHISKER, TOUCH, ICP=free, UZSTOP=stop, ILP=0, IID=0, **steps, **constants)

    def first_fold(self):
        """Returns the solutions and the label from which the fold curve starts."""
        free = [THETA, FORCE, ARC, PSI]
        push = self._start(WHISKER, FOLD_TOUCH, ICP=free, DS=-STEP, SP=["LP1"])
        start = self._restart(self._solutions(), push[-1].label, ISW=2, ICP=[*free, POLE], DS=STEP)
        return self._solutions(), start[-1].label

    def fold_curve(self, first, **constants):
        """Computes the fold curve from `first` to the tip."""
        free, stop = [POLE, FORCE, ARC, PSI, THETA], {ARC: 1.0}
        steps = {"DS": FOLD_STEP, "DSMAX": FOLD_STEP}
        self._restart(*first, ISW=2, ICP=free, UZSTOP=stop, ILP=0, IID=0, **steps, **constants)

    def cost(self, run):
        """Returns the microseconds per point, and the number of points."""
        whole, cut = [], []
        for _ in range(RUNS):
            run()
            whole.append((self.seconds, self.points))
            run(NMX=1)
            cut.append((self.seconds, self.points))
        (seconds, points), (start, first) = min(whole), min(cut)
        return {"microseconds": 1e6 * (seconds - start) / (points - first), "points": points}

    def push_angles(self):
        """Returns the push angles in radians at LOADS along the push, and at the first folds for POLES."""
        equilibria = self.branch(WHISKER, TOUCH, LOADS, [])[0]
        folds = self.folds(WHISKER, FOLD_TOUCH, POLES)[0]
        return [[equilibria[load][THETA] for load in LOADS], [folds[pole][THETA] for pole in POLES]]


def main():
    program = Path(sys.argv[1]).resolve()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        exact = TimedAuto(program, folder, EXACT_MESH, 1e-12).push_angles()
        for intervals in MESHES:
            auto = TimedAuto(program, folder, intervals, 1e-8)
            fold_curve = partial(auto.fold_curve, auto.first_fold())
            costs = [auto.cost(auto.equilibria), auto.cost(fold_curve)]
            errors = [max(abs(a - b) for a, b in zip(*pair)) for pair in zip(auto.push_angles(), exact)]
            kinds = ("equilibrium", "fold")
            rows += [
                {"kind": kind, "intervals": intervals, **cost, "error_max": error}
                for kind, cost, error in zip(kinds, costs, errors)
            ]
    query = ["dpkg-query", "--show", "--showformat=${Version}", "auto-07p"]
    version = subprocess.run(query, text=True, capture_output=True, check=True).stdout
    json.dump({"version": version, "rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
