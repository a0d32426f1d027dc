"""A scene's whisker as a dynamic rod of PyElastica, clamped to a base that turns, and a pole.

Units are mm, uN, s and g. Bending flexibility and mass are the true ones of each step. Stretch and shear are softened, and rotary
inertia is artificial, as their waves would need steps a hundred times shorter; neither changes what is measured.
"""

import sys
from math import pi
from pathlib import Path

import elastica as ea
import numpy as np
from pole import push

sys.path.append(str(Path(__file__).resolve().parents[3] / "tests" / "peers"))

from resting import Whisker, bisect

# Mass density of the whisker in g/mm3: that of keratin, and nearly that of printed plastic.
DENSITY = 1.3e-3
# Stretch stiffness at the base, by E I / L^2, and penalty of the contact there, by E I / L^3; both fall as the square of the radius.
STRETCH = 2.0e4
PENALTY = 1.5e6
# Part of the largest stable step.
STEP = 0.5


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    """The parts of PyElastica that are used."""


class Turn(ea.ConstraintBase):
    """Clamp at the second node, and a first element that turns with the base."""

    def __init__(self, *_state, course, step, **own):
        super().__init__(**own)
        self.course, self.step = course, step

    def constrain_values(self, system, time):
        angle = self.course(time)
        cos, sin = np.cos(angle), np.sin(angle)
        system.position_collection[:, 0] = -self.step * cos, -self.step * sin, 0.0
        system.position_collection[:, 1] = 0.0
        system.director_collection[:, :, 0] = (0.0, 0.0, 1.0), (sin, -cos, 0.0), (cos, sin, 0.0)

    def constrain_rates(self, system, time):
        rate = (self.course(time + 1e-6) - self.course(time - 1e-6)) / 2e-6
        angle = self.course(time)
        system.velocity_collection[:, 0] = self.step * rate * np.sin(angle), -self.step * rate * np.cos(angle), 0.0
        system.velocity_collection[:, 1] = 0.0
        system.omega_collection[:, 0] = rate, 0.0, 0.0


class Pole(ea.NoForces):
    """Contact force of the pole in uN, its place in steps from the first node, and its direction, as of the last step."""

    def __init__(self, own):
        super().__init__()
        self.own = own
        own.pole = self
        self.force, self.place, self.direction = 0.0, 0.0, (0.0, 0.0)

    def apply_forces(self, system, time=0.0):
        own = self.own
        self.force, self.place, *self.direction = push(
            system.position_collection, system.external_forces, own.stiffness, *own.centre, own.pole_radius
        )


class Rod:
    """One side of a scene against a pole that touches the resting whisker at `distance` mm.

    Nodes and elements are counted from one step before the base: node 1 is at the base, and element 0 turns with it.
    """

    def __init__(self, scene, side, distance, elements):
        self.whisker = whisker = Whisker(scene, side)
        self.side = side
        self.elements = elements
        self.step = whisker.length_mm / elements
        self.base = scene["whisker"]["base_radius_um"] * 1e-3
        self.modulus = scene["whisker"]["youngs_modulus_gpa"] * 1e9
        touch = whisker.slope_at_distance(distance / whisker.length_mm)
        self.at_touch = whisker.length_mm * np.array(whisker.pole_at(touch))
        self.pole_radius = whisker.length_mm * abs(whisker.pole)
        # Stiffness of the contact at each node.
        places = np.arange(elements + 2)
        unit = whisker.force_un / whisker.length_mm
        self.stiffness = PENALTY * unit * (self.radius(places) / self.base) ** 2
        self.rod = self.resting()
        self.set_material(self.rod)
        self.time_step = STEP * 2 / self.fastest()

    def radius(self, place):
        """Radius in mm at a place in steps from node 0."""
        return self.base * (1 - self.whisker.taper * np.clip((place - 1) / self.elements, 0, 1))

    def resting(self):
        """Creates a rod with its nodes on the resting whisker, of uniform material."""
        whisker, count = self.whisker, self.elements
        at = [
            bisect(lambda t, s=s: whisker.at(t)[3] - s, whisker.base_slope, whisker.tip_slope() + 1e-9)
            for s in np.arange(1, count + 1) / count
        ]
        nodes = whisker.length_mm * np.array([(-1 / count, 0), (0, 0), *(whisker.at(t)[:2] for t in at)])
        position = np.vstack([nodes.T, np.zeros(count + 2)])
        along, normal = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
        return ea.CosseratRod.straight_rod(
            count + 1, position[:, 0], along, normal, whisker.length_mm, self.base, DENSITY,
            youngs_modulus=self.modulus, shear_modulus=self.modulus / 3, position=position,
        )

    def set_material(self, rod):
        """Sets masses and stiffnesses of the tapered whisker, and its curvature at rest."""
        h, identity = self.step, np.eye(3)[:, :, None]
        places = np.arange(self.elements + 2)
        rod.mass[:] = DENSITY * h * pi * self.radius(places) ** 2
        rod.mass[[1, -1]] /= 2
        middle = self.radius(places[:-1] + 0.5)
        inertia = DENSITY * pi * middle**2 * h**3 / 4
        rod.mass_second_moment_of_inertia[:] = identity * inertia
        rod.inv_mass_second_moment_of_inertia[:] = identity / inertia
        rod.shear_matrix[:] = identity * (STRETCH * self.whisker.force_un * (middle / self.base) ** 2)
        # Mean flexibility between the middles of neighbouring elements; the half step before the base does not bend.
        one, two = middle[:-1].copy(), middle[1:]
        one[0] = self.base
        flexibility = (one**2 + one * two + two**2) / (3 * one**3 * two**3)
        flexibility[0] /= 2
        rod.bend_matrix[:] = identity * (self.modulus * pi / 4 / flexibility)
        rod.compute_internal_forces_and_torques(0.0)
        rod.rest_kappa[:] = rod.kappa
        rod.rest_sigma[:] = rod.sigma

    def fastest(self):
        """Largest angular frequency of the discrete rod, in 1/s, of stretch, bending and contact."""
        h, area = self.step, DENSITY * pi * self.base**2
        stretch = 2 * np.sqrt(STRETCH * self.whisker.force_un / area) / h
        bending = 2 * np.sqrt(self.modulus / DENSITY) * self.base / h**2
        contact = np.sqrt(PENALTY * self.whisker.force_un / self.whisker.length_mm / (area * h))
        return max(stretch, bending, contact)

    def start(self, course, damping):
        """Begins a run in which the base has turned by `course(t)` radians of push, damped by `damping` per second."""
        # The whisker begins at rest, where the base has not turned, and the pole lies where the course reaches it.
        start = course(0.0)
        cos, sin = np.cos(self.side * start), np.sin(self.side * start)
        self.centre = np.array([[cos, -sin], [sin, cos]]) @ self.at_touch
        self.simulator = simulator = Simulator()
        simulator.append(self.rod)
        angle = lambda time: -self.side * (course(time) - start)
        simulator.constrain(self.rod).using(
            Turn, course=angle, step=self.step, constrained_position_idx=(0, 1), constrained_director_idx=(0,))
        simulator.add_forcing_to(self.rod).using(Pole, self)
        simulator.dampen(self.rod).using(
            ea.AnalyticalLinearDamper, uniform_damping_constant=damping, time_step=self.time_step)
        simulator.finalize()
        self.stepper = ea.PositionVerlet()
        self.time = 0.0

    def advance(self):
        """Takes one step. Returns the force of the pole in uN."""
        self.time = self.stepper.step(self.simulator, self.time, self.time_step)
        return self.pole.force
