"""A whisker at rest, first touched by the pole: closed forms, and the units of the program's columns.

Lengths are in whisker lengths L_w, forces in E I_base / L_w^2. The base's frame has its first axis along the base's
tangent. In that frame's own direction the whisker is the parabola y = A (x - vertex)^2, run through by its slope t.
"""

from math import asinh, atan, atan2, cos, hypot, pi, sin, sqrt


def bisect(function, low, high):
    """The root of a growing function, to the last digit."""
    while low < (middle := (low + high) / 2) < high:
        low, high = (low, middle) if function(middle) > 0 else (middle, high)
    return middle


class Whisker:
    """One side of a scene's whisker: `side` is 1 for CB and -1 for CF."""

    def __init__(self, scene, side):
        whisker, curvature = scene["whisker"], scene["whisker"]["curvature"]
        self.side = side
        self.length_mm = whisker["length_mm"]
        self.curvature = curvature["parabola_per_mm"] * self.length_mm
        self.base_slope = -2 * curvature["parabola_per_mm"] * curvature.get("vertex_mm", 0.0)
        self.taper = 1 - whisker["tip_radius_um"] / whisker["base_radius_um"]
        self.pole = side * scene["pole"]["radius_mm"] / self.length_mm
        stiffness = whisker["youngs_modulus_gpa"] * 1e9 * pi / 4 * (whisker["base_radius_um"] * 1e-6) ** 4
        self.force_un = stiffness / (self.length_mm * 1e-3) ** 2 * 1e6
        self.moment_nnm = self.force_un * self.length_mm

    def at(self, t):
        """Position, tangent angle and arclength in the base's frame, where the slope is `t`."""
        t0, a = self.base_slope, self.curvature
        x, y = (t - t0) / (2 * a), (t * t - t0 * t0) / (4 * a)
        turn = atan(t0)
        arc = (t * sqrt(1 + t * t) + asinh(t) - t0 * sqrt(1 + t0 * t0) - asinh(t0)) / (4 * a)
        return x * cos(turn) + y * sin(turn), y * cos(turn) - x * sin(turn), atan(t) - turn, arc

    def pole_at(self, t):
        """The pole's centre in the base's frame, when it touches the resting whisker where the slope is `t`."""
        x, y, psi, _ = self.at(t)
        return x + self.pole * sin(psi), y - self.pole * cos(psi)

    def _slope(self, measure, value):
        # No point of interest is farther along the parabola's axis than twice the whisker's length.
        return bisect(lambda t: measure(t) - value, self.base_slope, self.base_slope + 4 * self.curvature)

    def slope_at_distance(self, distance):
        """The slope at `distance` from the base."""
        return self._slope(lambda t: hypot(*self.at(t)[:2]), distance)

    def slope_at_pole(self, distance):
        """The slope where a pole with its centre at `distance` from the base touches."""
        return self._slope(lambda t: hypot(*self.pole_at(t)), distance)

    def tip_slope(self):
        """The slope at the tip."""
        return self._slope(lambda t: self.at(t)[3], 1.0)

    def parameters(self, t):
        """AUTO's PAR(1..9), as named in whisker.f90, for the first touch where the slope is `t`."""
        x, y = self.pole_at(t)
        _, _, psi, arc = self.at(t)
        return [-atan2(y, x), 0.0, arc, psi, hypot(x, y), self.curvature, self.base_slope, self.taper, self.pole]

    def profile(self, t, intervals=200):
        """Rows of relative arclength and AUTO's U(1..5), from the base to the first touch where the slope is `t`."""
        theta, _, contact, *_ = self.parameters(t)
        for i in range(intervals + 1):
            slope = self.base_slope + (t - self.base_slope) * i / intervals
            x, y, turn, arc = self.at(slope)
            here = x * cos(theta) - y * sin(theta), x * sin(theta) + y * cos(theta)
            yield arc / contact, *here, theta + turn, slope, 1 - self.taper * arc

    def load(self, force_un, arc_length_mm):
        """AUTO's PAR(10), as in whisker.f90."""
        arc = arc_length_mm / self.length_mm
        return self.side * force_un / self.force_un * (arc / (1 - self.taper * arc)) ** 2

    def observe(self, par):
        """What the program's columns should say of a solution of AUTO's."""
        theta, force, arc, psi, distance = par[:5]
        touch = self.slope_at_pole(distance)
        at_touch = self.at(touch)
        x = distance * cos(theta) - self.pole * sin(psi)
        y = -distance * sin(theta) + self.pole * cos(psi)
        rest = self.at(self.slope_at_distance(hypot(x, y)))
        degrees = 180 / pi
        return {
            "distance_mm": hypot(*at_touch[:2]) * self.length_mm,
            "pole_distance_mm": distance * self.length_mm,
            "push_angle_deg": (self.parameters(touch)[0] - theta) * degrees,
            "push_chord_deg": (atan2(y, x) - atan2(rest[1], rest[0])) * degrees,
            "contact_angle_deg": psi * degrees,
            "contact_distance_mm": hypot(x, y) * self.length_mm,
            "arc_length_mm": arc * self.length_mm,
            "force_un": abs(force) * self.force_un,
            "base_force_x_un": -force * sin(psi) * self.force_un,
            "base_force_y_un": force * cos(psi) * self.force_un,
            "base_moment_nnm": force * (x * cos(psi) + y * sin(psi)) * self.moment_nnm,
        }
