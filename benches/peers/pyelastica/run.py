"""Pushes the whisker of a scene against a pole in PyElastica, at constant speed until it detaches, or held at push angles.

    run.py SCENE --distance MM --side cb|cf --detach DEG [--rates DEG_PER_S ...] [--hold DEG ...]
           [--elements N ...] [--damping PER_S ...] [-o FOLDER]

`--detach` is the quasi-static push angle at detachment, of `whiskmap curve`: slow pushes hurry to a place shortly before it. Results are
added to detachments.csv, forces.csv (fast pushes, means over steps) and held.csv in FOLDER.
"""

import argparse
import csv
import time
import tomllib
from math import atan2, degrees, hypot, pi, radians
from pathlib import Path

import numpy as np
from rod import Rod

# A push at this rate or faster, in degrees per second, begins free of the pole; a slower one, this many degrees before detachment.
FAST = 60.0
MARGIN = 0.25
# Degrees of push before first touch at which a fast push begins; its speed is reached after half of them.
BEFORE = 4.0
# Rows of a run in forces.csv.
ROWS = 50


def smooth(x):
    """A step from 0 to 1 with continuous acceleration."""
    x = min(max(x, 0.0), 1.0)
    return x**3 * (10 - 15 * x + 6 * x * x)


def fast(rate):
    """Constant `rate` in degrees per second, after a start of constant acceleration."""
    speed, start = radians(rate), -radians(BEFORE)
    rise = -start / speed  # half of `BEFORE` at half the speed

    def course(t):
        return start + (speed * t * t / (2 * rise) if t < rise else speed * (t - rise / 2))

    return course, 0.0


def slow(rate, detach, damping):
    """Constant `rate` from shortly before detachment, when the whisker has come to rest there."""
    start, rise = radians(detach - MARGIN), 0.06
    begin = rise + 12 / damping

    def course(t):
        if t < begin:
            return -radians(0.5) + (start + radians(0.5)) * smooth(t / rise)
        return start + radians(rate) * (t - begin)

    return course, begin


def has_passed(rod):
    """True if the tip is beyond the pole."""
    x, y = rod.rod.position_collection[:2, -1]
    px, py = rod.centre
    return rod.side * (px * y - py * x) < -rod.pole_radius * hypot(x, y)


def detachment(rod, rate, detach, damping, limit):
    """Pushes until the tip has passed the pole. Returns the last push angle with contact, and rows of push angle and force."""
    course, begin = fast(rate) if rate >= FAST else slow(rate, detach, damping)
    rod.start(course, damping)
    every = max(1, int(radians(detach) / radians(rate) / rod.time_step / ROWS))
    last, rows, step, total = None, [], 0, 0.0
    while True:
        force = rod.advance()
        step += 1
        total += force
        if force > 0:
            last = degrees(course(rod.time))
        if step % every == 0:
            if rod.time > begin:
                rows.append((degrees(course(rod.time - rod.time_step * every / 2)), total / every))
            total = 0.0
            if has_passed(rod):
                return last, rows
            if course(rod.time) > radians(limit):
                return None, rows


def held(rod, angles, damping):
    """Yields angle, force, base moment and arc length of the contact, after rest at each push angle."""
    rise, rest = 0.03, max(12 / damping, 0.08)
    steps = [-0.5, *angles]

    def course(t):
        i = min(int(t / (rise + rest)), len(angles) - 1)
        return radians(steps[i] + (steps[i + 1] - steps[i]) * smooth((t - i * (rise + rest)) / rise))

    rod.start(course, damping)
    for i, angle in enumerate(angles):
        while rod.time < (i + 1) * (rise + rest):
            force = rod.advance()
        fx, fy = (force * part for part in rod.pole.direction)
        contact = np.array(rod.centre) + rod.pole_radius * np.array(rod.pole.direction)
        yield angle, force, contact[0] * fy - contact[1] * fx, (rod.pole.place - 1) * rod.step


def add(file, columns, rows):
    """Appends rows to a CSV file; a new one begins with its columns."""
    is_new = not file.exists()
    with file.open("a", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        if is_new:
            writer.writerow(columns)
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--distance", type=float, required=True)
    parser.add_argument("--side", choices=["cb", "cf"], default="cb")
    parser.add_argument("--detach", type=float, required=True)
    parser.add_argument("--rates", type=float, nargs="*", default=[])
    parser.add_argument("--hold", type=float, nargs="*", default=[])
    parser.add_argument("--elements", type=int, nargs="+", default=[40])
    parser.add_argument("--damping", type=float, nargs="+", default=[600.0])
    parser.add_argument("-o", dest="folder", type=Path, default=Path(__file__).parent)
    options = parser.parse_args()
    scene = tomllib.loads(options.scene.read_text())
    side = 1 if options.side == "cb" else -1
    for elements in options.elements:
        for damping in options.damping:
            case = (options.scene.stem, options.side, options.distance, elements, damping)
            names = ("scene", "side", "distance_mm", "elements", "damping_per_s")
            make = lambda: Rod(scene, side, options.distance, elements)
            if options.hold:
                rows = [(*case, *row) for row in held(make(), options.hold, damping)]
                add(options.folder / "held.csv", (*names, "push_angle_deg", "force_un", "base_moment_nnm", "arc_length_mm"), rows)
            for rate in options.rates:
                begun = time.time()
                rod = make()
                end, rows = detachment(rod, rate, options.detach, damping, 3 * options.detach + 60)
                if rate >= FAST:
                    columns = (*names, "rate_deg_per_s", "push_angle_deg", "force_un")
                    add(options.folder / "forces.csv", columns,
                        [(*case, rate, f"{angle:.5g}", f"{force:.5g}") for angle, force in rows])
                seconds = time.time() - begun
                add(options.folder / "detachments.csv", (*names, "rate_deg_per_s", "push_angle_deg", "steps", "seconds"),
                    [(*case, rate, end, round(rod.time / rod.time_step), f"{seconds:.0f}")])
                print(*case, rate, end, f"{seconds:.0f} s", f"step {rod.time_step:.3g} s", flush=True)


if __name__ == "__main__":
    main()
