"""AUTO-07p as functions: the runs of the comparison, from constants to labelled solutions."""

import os
import subprocess
from dataclasses import dataclass
from math import fmod
from pathlib import Path

# Numbers of the parameters, as in whisker.f90.
THETA, FORCE, ARC, PSI, POLE, LOAD = 1, 2, 3, 4, 5, 10
# The first step, along the first parameter of ICP; AUTO looks for nothing within it.
STEP = 0.002
# The longest steps, tried in turn: about once in 2000 times AUTO's search for a fold or a wanted value ends beside it,
# without a word, and other steps make another search.
LONGEST_STEPS = (0.03, 0.02, 0.013)


@dataclass(frozen=True)
class Solution:
    """One labelled solution; indexed by the numbers of the parameters."""

    kind: int
    label: int
    par: list

    def __getitem__(self, parameter):
        return self.par[parameter - 1]

    def is_fold(self):
        return self.kind == 5


class Auto:
    """AUTO, linked with whisker.f90 into `program`; its files live in `folder`."""

    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)
        self.common = (Path(__file__).parent / "auto" / "c.whisker").read_text()

    def branch(self, whisker, slope, loads, folds):
        """From the first touch where the slope is `slope`: by load, the solutions at `loads` and the folds expected at
        `folds`; and all that AUTO labels, first touch first."""

        def run(**constants):
            free, stop = [THETA, FORCE, ARC, PSI, LOAD], {LOAD: 1.02 * max([*loads, *folds], key=abs)}
            return self._start(whisker, slope, ICP=free, DS=-STEP * whisker.side, UZSTOP=stop, **constants)

        return reach(run, LOAD, loads, folds)

    def folds(self, whisker, seed_slope, poles):
        """The first folds at the pole distances `poles`, continued from the one where a push from first touch at
        `seed_slope` ends, and the fold with the contact at the tip."""
        free = [THETA, FORCE, ARC, PSI]
        seed = self._start(whisker, seed_slope, ICP=free, DS=-STEP * whisker.side, SP=["LP1"])
        # In two parameters, those of the null vector in the middle. A first run makes the null vector, at one pole.
        start = self._restart(self._solutions(), seed[-1].label, ISW=2, ICP=[*free, POLE], DS=STEP)[-1]
        start_file = self._solutions()
        free = [POLE, FORCE, ARC, PSI, THETA]
        stop = {ARC: 1.0, POLE: 0.97 * min(*poles, start[POLE])}

        def run(**constants):
            both = []
            for step in (-STEP, STEP):
                both += self._restart(start_file, start.label, ISW=2, ICP=free, DS=step, UZSTOP=stop, **constants)
            return both

        found, solutions = reach(run, POLE, poles)
        return found, solutions[-1]

    def pull_offs(self, whisker, poles, corner):
        """The contact at the tip, at the pole distances `poles`; from first touch to the pole distance `corner`."""

        def run(**constants):
            free = [FORCE, POLE, THETA, PSI]
            slope = whisker.tip_slope()
            return self._start(whisker, slope, ICP=free, DS=STEP * whisker.side, UZSTOP={POLE: corner}, **constants)

        return reach(run, POLE, poles)[0]

    def _start(self, whisker, slope, **constants):
        rows = (" ".join(map(repr, row)) for row in whisker.profile(slope))
        (self.folder / "rest.dat").write_text("\n".join(rows) + "\n")
        par = dict(enumerate(whisker.parameters(slope), 1))
        return self._run(IRS=0, ISW=1, dat="rest.dat", PAR=par, **constants)

    def _restart(self, solutions, label, **constants):
        (self.folder / "fort.3").write_text(solutions)
        return self._run(IRS=label, **constants)

    def _solutions(self):
        return (self.folder / "fort.8").read_text()

    def _run(self, **constants):
        lines = [f"{name}={value!r}" for name, value in constants.items()]
        (self.folder / "fort.2").write_text(self.common + "\n".join(lines) + "\n")
        environment = os.environ | {"OMP_NUM_THREADS": "1"}
        run = subprocess.run([self.program], cwd=self.folder, env=environment, text=True, capture_output=True)
        # AUTO's exit code is 0 even where it stops early: what must be there is for the caller to count.
        if run.returncode != 0:
            raise RuntimeError(f"AUTO failed with {run.returncode}:\n{run.stdout}{run.stderr}")
        return list(self._labelled())

    def _labelled(self):
        """The solutions of fort.8: a header, whose 9th number counts the lines after it; the last of them hold PAR."""
        lines = iter(self._solutions().splitlines())
        for line in lines:
            header = [int(number) for number in line.split()]
            block = [next(lines) for _ in range(header[8])]
            par_lines = -(-header[11] // 7)
            par = [float(number) for number in " ".join(block[-par_lines:]).split()]
            yield Solution(int(fmod(header[2], 10)), header[3], par)


def reach(run, parameter, wanted, folds=()):
    """By value of `parameter`, the solutions at the `wanted` values and the folds expected at the values `folds`; and
    all that the last run labelled."""
    found, labelled = {}, []
    for longest in LONGEST_STEPS:
        missing = [value for value in wanted if value not in found]
        if not missing and all(value in found for value in folds):
            break
        labelled = run(DSMAX=longest, **({"UZR": {parameter: missing}} if missing else {}))
        # Where a fold is expected nothing else was asked for, so what is there is the fold.
        for value in [*missing, *folds]:
            nearest = min(labelled, key=lambda solution: abs(solution[parameter] - value))
            if abs(nearest[parameter] - value) <= 1e-8 * (1 + abs(value)):
                found[value] = nearest
    return found, labelled
