"""AUTO-07p on the cone: equilibria along one push, and points of the fold curve in two parameters.

    auto_peer.py PROGRAM        tests/peers/auto/whisker.f90, linked with AUTO's objects; prints JSON

The cost of a point is the time of the whole process, less that of the same run cut short after its first point, by
the points in between. Exact Jacobians; steps of one length, about a cell of the map, or on the fold curve a row of it.
AUTO looks for nothing on the way and prints no point but the last. Errors are those of a push angle in radians, at
given loads and at given places of the pole, against a much finer mesh; AUTO prints 11 digits of it.
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
# 76 equilibria up to the fold, and 362 folds from a pole at 0.45 of the length to the tip.
EQUILIBRIUM_STEP, FOLD_STEP = 0.023, 0.003
# The fold of this push is at the load 10.4, and the fold curve ends with the contact at the tip, the pole at 0.958.
LAST_LOAD = 10.4
LOADS = [0.5 * n for n in range(1, 21)]
FOLD_TOUCH, POLES = WHISKER.slope_at_distance(0.45), [0.02 * n for n in range(23, 48)]


class TimedAuto(Auto):
    """AUTO on some number of mesh intervals; `seconds` and `points` are those of the last run."""

    def __init__(self, program, folder, intervals, tolerance):
        super().__init__(program, folder)
        self.common += f"NTST={intervals}\nEPSL={tolerance}\nEPSU={tolerance}\n"

    def _run(self, **constants):
        before = perf_counter()
        labelled = super()._run(**constants)
        self.seconds = perf_counter() - before
        rows = (self.folder / "fort.7").read_text().splitlines()
        # Rows of the header are marked by a zero, those of points by the number of their branch.
        self.points = sum(row.split()[0] != "0" for row in rows)
        return labelled

    def equilibria(self, **constants):
        """From first touch to the fold."""
        free, stop = [THETA, FORCE, ARC, PSI, LOAD], {LOAD: LAST_LOAD}
        steps = {"DS": -EQUILIBRIUM_STEP, "DSMAX": EQUILIBRIUM_STEP}
        self._start(WHISKER, TOUCH, ICP=free, UZSTOP=stop, ILP=0, IID=0, **steps, **constants)

    def first_fold(self):
        """The solutions and the label from which the fold curve starts."""
        free = [THETA, FORCE, ARC, PSI]
        push = self._start(WHISKER, FOLD_TOUCH, ICP=free, DS=-STEP, SP=["LP1"])
        start = self._restart(self._solutions(), push[-1].label, ISW=2, ICP=[*free, POLE], DS=STEP)
        return self._solutions(), start[-1].label

    def fold_curve(self, first, **constants):
        """From `first` to the tip."""
        free, stop = [POLE, FORCE, ARC, PSI, THETA], {ARC: 1.0}
        steps = {"DS": FOLD_STEP, "DSMAX": FOLD_STEP}
        self._restart(*first, ISW=2, ICP=free, UZSTOP=stop, ILP=0, IID=0, **steps, **constants)

    def cost(self, run):
        """Microseconds by point, and the number of points."""
        whole, cut = [], []
        for _ in range(RUNS):
            run()
            whole.append((self.seconds, self.points))
            run(NMX=1)
            cut.append((self.seconds, self.points))
        (seconds, points), (start, first) = min(whole), min(cut)
        return {"microseconds": 1e6 * (seconds - start) / (points - first), "points": points}

    def push_angles(self):
        """At LOADS along the push, and at the first folds for POLES."""
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
