"""The trajectories that whiskmap and heyoka solve, with exact results: whiskmap's benchmark writes them as CSV.

Each is a whisker of some taper beta and bend A*, with the contact at arclength s and the force f. The results are the
position of the base from the contact, and its first derivatives by s and f. Lengths are in whisker lengths, forces in
E I_base / L_w^2.
"""

import numpy as np


class Ensemble:
    """Arrays with one entry per trajectory."""

    def __init__(self, path):
        table = np.genfromtxt(path, delimiter=",", names=True)
        self.taper, self.bend, self.s, self.force = (table[name] for name in ("taper", "bend", "arclength", "force"))
        self.position = table["x"] + 1j * table["y"]
        self.by_s = table["ln_d_by_s"] + 1j * table["phi_by_s"]
        self.by_force = table["ln_d_by_f"] + 1j * table["phi_by_f"]
        # Radius at the contact over that at the base.
        self.radius = 1 - self.taper * self.s

        self.is_bent = bool(self.bend.any())

    def scenes(self):
        """Returns two ensembles: the straight whiskers and the bent ones."""
        return [self._of(self.bend == 0), self._of(self.bend != 0)]

    def sort(self, key):
        """Sorts the trajectories by `key`."""
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
        """Returns the largest difference of the six real results of each trajectory, each relative to its own scale."""
        length, stiffness = self.s, (self.radius / self.s) ** 2
        differences = [
            (position - self.position) / length,
            (by_s - self.by_s) * length,
            (by_force - self.by_force) * stiffness,
        ]
        parts = [part for each in differences for part in (np.abs(each.real), np.abs(each.imag))]
        return np.max(parts, axis=0)
