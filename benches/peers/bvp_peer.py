"""scipy's solve_bvp on cells of the cone's map: force and contact arclength for a given position of the pole.

    bvp_peer.py        prints JSON

The formulation is that of whiskmap, with the fewest equations: u runs from the contact (0) to the base (1),
tau = T (1 - u), rho = exp(-beta tau), and the axes are those of the contact.

    theta' = -T (rho kappa_i(t) - f X/rho^3)   t' = -T rho 2A/sqrt(1 + t^2)   X' = -T rho cos(theta)
    Y' = -T rho sin(theta)

At the contact theta = X = Y = 0; at the base t is known, and the pole is at its given position.
Unknown parameters: T, f. Jacobians are analytic. Each cell starts from its neighbour's solution; the cells
are one row of the map.
"""

import json
import sys
from cmath import exp
from math import log1p
from time import perf_counter

import numpy as np
import scipy
from cone import CELL, TOUCH, WHISKER
from scipy.integrate import solve_bvp, solve_ivp

CELLS = 54
RUNS = 5
# Initial numbers of mesh nodes, and tolerances; solve_bvp refines a mesh where necessary.
NODES, TOLERANCES = (20, 40, 60, 80, 100, 120, 160), (1e-3, 1e-6, 1e-7)
# Largest difference between Jacobians and central differences of the functions, which are accurate to about 1e-9.
JACOBIAN_TOLERANCE = 1e-6

beta, bend, radius = WHISKER.taper, WHISKER.curvature, WHISKER.pole


def rhs(u, y, parameters):
    theta, x, _, t = y
    T, force = parameters
    rho, root = np.exp(-beta * T * (1 - u)), np.sqrt(1 + t * t)
    bending = 2 * bend / root**3 - force * x / rho**4
    return -T * rho * np.array([bending, np.cos(theta), np.sin(theta), 2 * bend / root])


def rhs_jacobian(u, y, parameters):
    theta, x, _, t = y
    T, force = parameters
    rho, root = np.exp(-beta * T * (1 - u)), np.sqrt(1 + t * t)
    by_state, by_parameters = np.zeros((4, 4, u.size)), np.empty((4, 2, u.size))
    by_state[0, 1] = T * force / rho**3
    by_state[0, 3] = T * rho * 6 * bend * t / root**5
    by_state[1, 0] = T * rho * np.sin(theta)
    by_state[2, 0] = -T * rho * np.cos(theta)
    by_state[3, 3] = T * rho * 2 * bend * t / root**3
    by_parameters[:, 0] = (1 / T - beta * (1 - u)) * rhs(u, y, parameters)
    by_parameters[0, 0] += 4 * beta * (1 - u) * T * force * x / rho**3
    by_parameters[:, 1] = 0
    by_parameters[0, 1] = T * x / rho**3
    return by_state, by_parameters


def boundary(pole):
    """Residuals and their Jacobians, for the pole's centre at the complex number `pole` in the base's frame."""

    def centre(base):
        return -(base[1] + 1j * (base[2] + radius)) * exp(-1j * base[0])

    def residuals(contact, base, _):
        apart = centre(base) - pole
        return np.array([*contact[:3], base[3] - WHISKER.base_slope, apart.real, apart.imag])

    def jacobians(_contact, base, _):
        by_contact, by_base = np.eye(6, 4), np.zeros((6, 4))
        by_contact[3, 3], by_base[3, 3] = 0, 1
        turn = exp(-1j * base[0])
        columns = np.array([-1j * centre(base), -turn, -1j * turn])
        by_base[4, :3], by_base[5, :3] = columns.real, columns.imag
        return by_contact, by_base, np.zeros((6, 2))

    return residuals, jacobians


def push(nodes, tolerance):
    """Solves the cells one after the other; returns their contact arclengths, and the seconds per cell."""
    T = -log1p(-beta * WHISKER.at(TOUCH)[3]) / beta
    resting, mesh = np.array([T, 0.0]), np.linspace(0, 1, nodes)
    whisker = solve_ivp(rhs, (0, 1), [0, 0, 0, TOUCH], t_eval=mesh, args=(resting,), rtol=1e-10, atol=1e-12)
    guess, parameters, touch = whisker.y, resting, complex(*WHISKER.pole_at(TOUCH))
    arcs, seconds = [], []
    for cell in range(1, CELLS + 1):
        residuals, jacobians = boundary(touch * exp(1j * cell * CELL))
        exact = {"fun_jac": rhs_jacobian, "bc_jac": jacobians}
        tolerances = {"tol": tolerance, "bc_tol": min(1e-10, 1e-3 * tolerance)}
        before = perf_counter()
        found = solve_bvp(rhs, residuals, mesh, guess, parameters, **exact, **tolerances)
        seconds.append(perf_counter() - before)
        if not found.success:
            sys.exit(f"solve_bvp failed in cell {cell} with {nodes} nodes at {tolerance}: {found.message}")
        guess, parameters = found.sol(mesh), found.p
        arcs.append(-np.expm1(-beta * found.p[0]) / beta)
    return np.array(arcs), seconds


def check_jacobians():
    """Exits if the Jacobians differ from differences of the functions at a generic state."""
    random, step = np.random.default_rng(1), 1e-5
    u, y, parameters = np.linspace(0, 1, 5), random.uniform(0.2, 0.8, (4, 5)), np.array([1.4, 0.7])
    by_state, by_parameters = rhs_jacobian(u, y, parameters)
    residuals, jacobians = boundary(0.7 + 0.2j)
    by_base = jacobians(y[:, 0], y[:, 1], parameters)[1]
    for i, unit in enumerate(step * np.eye(4)):
        column = unit[:, None]
        apart = rhs(u, y + column, parameters) - rhs(u, y - column, parameters) - 2 * step * by_state[:, i]
        assert np.abs(apart).max() < 2 * step * JACOBIAN_TOLERANCE
        apart = residuals(y[:, 0], y[:, 1] + unit, 0) - residuals(y[:, 0], y[:, 1] - unit, 0) - 2 * step * by_base[:, i]
        assert np.abs(apart).max() < 2 * step * JACOBIAN_TOLERANCE
    for i, unit in enumerate(step * np.eye(2)):
        apart = rhs(u, y, parameters + unit) - rhs(u, y, parameters - unit) - 2 * step * by_parameters[:, i]
        assert np.abs(apart).max() < 2 * step * JACOBIAN_TOLERANCE


def main():
    check_jacobians()
    exact = push(800, 1e-8)[0]
    rows = []
    for nodes in NODES:
        for tolerance in TOLERANCES:
            arcs, seconds = zip(*(push(nodes, tolerance) for _ in range(RUNS)))
            rows.append(
                {
                    "nodes": nodes,
                    "tolerance": tolerance,
                    "microseconds": 1e6 * min(map(np.mean, seconds)),
                    "error_max": np.abs(arcs[0] / exact - 1).max(),
                }
            )
    json.dump({"version": scipy.__version__, "cells": CELLS, "rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
