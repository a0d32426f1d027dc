"""Compares `whiskmap curve` and `whiskmap branch` with AUTO-07p, point by point.

    compare.py WHISKMAP AUTO        AUTO: auto/whisker.f90, compiled and linked with AUTO's objects

The two share no equation: whiskmap integrates from the contact back to the base, AUTO solves the paper's boundary-value
problem from the base to the contact by collocation. Exit code 1 if they disagree, or if less was compared than asked.
"""

import csv
import re
import subprocess
import sys
import tempfile
from math import hypot
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("compare.py needs Python 3.11 or later: it reads scenes with tomllib")
import tomllib

from continuation import LOAD, POLE, Auto
from report import HEADER, TOLERANCE, Report, must_notice
from resting import Whisker

SCENES = ("cone", "cylinder", "fig4_whisker", "fig4_hair", "fig5_left")
SIDES = {"cb": 1, "cf": -1}
FOLDS = ("slip-off", "second-fold")
# Fractions of the length. No resting tip reaches the last distance; all reach the one before it.
CURVE_DISTANCES = (0.2, 0.27, 0.34, 0.41, 0.48, 0.55, 0.62, 0.69, 0.76, 0.83, 0.9, 0.97, 1.0)
BRANCH_DISTANCES = (0.3, 0.6, 0.8)
# AUTO takes some 100 wanted values in one run.
BRANCH_POINTS = 24
# Where the fold curve is picked up: where every whisker here has a fold, and not next to a distance above.
SEED_DISTANCE = 0.45

ANGLES = ["push_angle_deg", "push_chord_deg", "contact_angle_deg"]
BRANCH_COLUMNS = [*ANGLES, "arc_length_mm", "force_un", "base_moment_nnm"]
PLACES = ["distance_mm", "pole_distance_mm", "contact_distance_mm"]
CURVE_COLUMNS = [*BRANCH_COLUMNS, *PLACES, "base_force_x_un", "base_force_y_un"]


def compare_curve(report, auto, whisker, rows, corner_row, more_poles):
    """Slip-off, pull-off, and the corner between them; returns AUTO's folds, at the pole distances `more_poles` too."""
    poles = [float(row["pole_distance_mm"]) / whisker.length_mm for row in rows]
    slip_offs, pull_offs = (
        [pole for row, pole in zip(rows, poles) if row["kind"] == kind] for kind in ("slip-off", "pull-off")
    )
    folds, corner = auto.folds(whisker, whisker.slope_at_distance(SEED_DISTANCE), slip_offs + more_poles)
    at_tip = auto.pull_offs(whisker, pull_offs, corner[POLE])

    tip_mm = hypot(*whisker.at(whisker.tip_slope())[:2]) * whisker.length_mm
    for row, pole in zip(rows, poles):
        if row["kind"] == "out-of-reach":
            report.demand(float(row["distance_mm"]) > tip_mm, f"the resting tip is at {tip_mm} mm: {row}")
        elif row["kind"] == "pull-off":
            report.demand(pole > corner[POLE], f"the fold comes before the tip: {row}")
            report.compare(whisker, row, CURVE_COLUMNS, at_tip.get(pole))
        else:
            report.compare(whisker, row, CURVE_COLUMNS, folds.get(pole))
    report.demand(len(rows) == len(CURVE_DISTANCES), f"{len(rows)} rows for {len(CURVE_DISTANCES)} distances")
    report.demand(report.points >= len(rows) - 1, f"only {report.points} points compared")
    if whisker.observe(corner.par)["distance_mm"] < tip_mm:
        report.compare(whisker, corner_row, ["distance_mm", "push_angle_deg"], corner)
    else:
        report.demand(corner_row["distance_mm"] == "", f"AUTO's corner is out of reach: {corner_row}")

    if not report.wrong:
        slip_off = next(row for row in rows if row["kind"] == "slip-off")
        must_notice(whisker, slip_off, CURVE_COLUMNS, folds[slip_offs[0]])
    return folds


def compare_branch(report, auto, whisker, slope, rows, fold):
    """One branch from first touch to its end; `fold` is AUTO's on the fold curve, where it solves for it."""
    marks = [row["mark"] for row in rows]
    loads = [whisker.load(float(row["force_un"]), float(row["arc_length_mm"])) for row in rows]
    wanted = [load for load, mark in zip(loads, marks) if mark in ("", "tip", "pull-off")]
    expected_folds = [load for load, mark in zip(loads, marks) if mark in FOLDS]
    points, labelled = auto.branch(whisker, slope, wanted, expected_folds)
    for row, load in zip(rows, loads):
        known = {"first-touch": labelled[0], "slip-off": fold}
        report.compare(whisker, row, BRANCH_COLUMNS, known.get(row["mark"], points.get(load)))
    report.demand(len(rows) == BRANCH_POINTS, f"{len(rows)} points of {BRANCH_POINTS}")

    # A fold at the very end is the second fold, which ends the branch like the tip.
    folds = [abs(solution[LOAD]) for solution in labelled if solution.is_fold()]
    inside = [load for load in folds if load < (1 - 1e-6) * abs(loads[-1])]
    report.demand(len(inside) == marks.count("slip-off") <= 1, f"AUTO's folds are at the loads {folds}, marks: {marks}")
    for row, load in zip(rows, loads):
        if row["mark"] != "slip-off":
            stable = str(not inside or abs(load) < inside[0]).lower()
            report.demand(row["stable"] == stable, f"stable is {stable} for AUTO, whose folds are at {folds}: {row}")
    signs = {(row["stable"], float(row["det"]) > 0) for row in rows if row["mark"] not in FOLDS}
    report.demand(len(signs) == 1 + len(inside), f"det must change its sign at the fold and nowhere else: {signs}")

    at_tip = abs(float(rows[-1]["arc_length_mm"]) / whisker.length_mm - 1) <= TOLERANCE["mm"]
    ends = {"tip": at_tip, "pull-off": at_tip, "second-fold": loads[-1] in points}
    whole = marks[0] == "first-touch" and ends.get(marks[-1], False)
    report.demand(whole, f"a branch goes from first touch to the tip or its second fold: {marks}")


def compare_scene(auto, whiskmap, text, name, folder):
    """All reports of one scene; `text` is its file."""

    def table(command, *options):
        arguments = [whiskmap, command, scene, *map(str, options), "--csv", "-"]
        run = subprocess.run(arguments, text=True, capture_output=True)
        if run.returncode != 0:
            sys.exit(f"FAIL: {' '.join(map(str, arguments))} ended with {run.returncode}:\n{run.stderr}")
        return list(csv.DictReader(run.stdout.splitlines()))

    parsed = tomllib.loads(text)
    length = parsed["whisker"]["length_mm"]
    scene = folder / f"{name}.toml"
    distances = [fraction * length for fraction in CURVE_DISTANCES]
    scene.write_text(re.sub(r"(?m)^distance_mm *=.*$", f"distance_mm = {distances}", text))
    curves, corners = table("curve"), table("curve", "--corner")

    for side, sign in SIDES.items():
        whisker = Whisker(parsed, sign)
        branches, poles_of_folds = [], []
        for fraction in BRANCH_DISTANCES:
            distance = fraction * length
            slope = whisker.slope_at_distance(fraction)
            rows = table("branch", "--distance", distance, "--side", side, "--points", BRANCH_POINTS)
            pole = whisker.parameters(slope)[POLE - 1]
            poles_of_folds += [pole for row in rows if row["mark"] == "slip-off"]
            branches.append((f"{name} {side} branch at {distance:g} mm", slope, rows, pole))

        report = Report(f"{name} {side} curve")
        rows, (corner,) = ([row for row in rows if row["side"] == side] for rows in (curves, corners))
        folds = compare_curve(report, auto, whisker, rows, corner, poles_of_folds)
        yield report
        for case, slope, rows, pole in branches:
            report = Report(case)
            compare_branch(report, auto, whisker, slope, rows, folds.get(pole))
            yield report


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    whiskmap, program = (Path(argument).resolve() for argument in sys.argv[1:])
    scenes = Path(__file__).resolve().parents[2] / "scenes"
    reports = []
    print(HEADER)
    with tempfile.TemporaryDirectory() as folder:
        auto = Auto(program, folder)
        for name in SCENES:
            text = (scenes / f"{name}.toml").read_text()
            for report in compare_scene(auto, whiskmap, text, name, Path(folder)):
                print(report.line(), flush=True)
                reports.append(report)
    for report in reports:
        for complaint in report.wrong[:5]:
            print(f"DISAGREEMENT in {report.case} ({len(report.wrong)} in all): {complaint}", file=sys.stderr)
    points = sum(report.points for report in reports)
    failed = [report.case for report in reports if report.wrong]
    if failed:
        sys.exit(f"FAIL: whiskmap and AUTO-07p disagree in {len(failed)} of {len(reports)} cases, {points} points")
    worst = max(report.worst["deg"] for report in reports)
    print(f"PASS: {points} points agree with AUTO-07p; no angle differs by more than {worst:.1e} degrees")


if __name__ == "__main__":
    main()
