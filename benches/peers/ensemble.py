"""The trajectories that whiskmap and heyoka both solve, with exact answers: whiskmap's bench writes them as CSV.

Each is a whisker of some taper beta and bend A*, touched at arclength s with force f. Wanted are the base, as seen from
the contact, and its first derivatives by s and f. Lengths are in whisker lengths, forces in E I_base / L_w^2.
"""

import numpy as np


class Ensemble:
    """Arrays with one entry for each trajectory."""

    def __init__(self, path):
        table = np.genfromtxt(path, delimiter=",", names=True)
        self.taper, self.bend, self.s, self.force = (table[name] for name in ("taper", "bend", "arclength", "force"))
        self.position = table["x"] + 1j * table["y"]
        self.by_s = table["ln_d_by_s"] + 1j * table["phi_by_s"]
        self.by_force = table["ln_d_by_f"] + 1j * table["phi_by_f"]
        # Radius at the contact, as a part of the base's.
        self.radius = 1 - self.taper * self.s

        self.is_bent = bool(self.bend.any())

    def scenes(self):
        """The straight whiskers and the bent ones, each as an ensemble of their own."""
        return [self._of(self.bend == 0), self._of(self.bend != 0)]

    def sort(self, key):
        """Puts the trajectories in the order of `key`."""
        self.__dict__ |= vars(self._of(np.argsort(key)))

    def _of(self, chosen):
        part = object.__new__(Ensemble)
        part.__dict__ = {name: value[chosen] for name, value in vars(self).items() if name != "is_bent"}
        part.is_bent = bool(part.bend.any())
        return part

    def slope(self):
        """Slope t of the resting parabola at the contact: t sqrt(1 + t^2) + asinh(t) = 4 A s, by Newton."""
        target = 4 * self.bend * self.s
        t = target / 2
        for _ in range(20):
            root = np.hypot(1, t)
            t = t - (t * root + np.arcsinh(t) - target) / (2 * root)
        return t

    def error(self, position, by_s, by_force):
        """For each trajectory, the largest difference of its six real numbers, each by its own size."""
        length, stiffness = self.s, (self.radius / self.s) ** 2
        differences = [
            (position - self.position) / length,
            (by_s - self.by_s) * length,
            (by_force - self.by_force) * stiffness,
        ]
        parts = [part for each in differences for part in (np.abs(each.real), np.abs(each.imag))]
        return np.max(parts, axis=0)
