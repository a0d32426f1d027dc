"""heyoka on the ensemble: Taylor's method, compiled just in time, many trajectories side by side in SIMD lanes.

    heyoka_peer.py ENSEMBLE.CSV        prints JSON with one row for each number of threads, batch size and order

Batch mode, non-compact, AVX-512 if available, fast_math (10 % faster, equally exact), and the fastest of the
formulations tried. From the contact back to the base, in units of the contact's arclength s, with
d(sigma) = -da / rho, rho = exp(beta sigma) rho_c, and the unit tangent times rho as (C, S):

    C' = beta C + K S     S' = beta S - K C     K = k + p G x     x' = C     y' = S     G' = -3 beta G
    k' = beta k + 3 k m   m' = beta m - k^2 + 2 m^2

x + iy is the position of the contact from the base, along the contact's axes; G = (rho_c/rho)^3; p = f s^2/rho_c^3; k is
rho times the resting curvature and m is k times the resting slope: polynomials only. Sensitivities, by s and by p:

    theta_s' = -p G x_s           x_s' = -S theta_s    y_s' = C theta_s
    theta_p' = -G x - p G x_p     x_p' = -S theta_p    y_p' = C theta_p

Microseconds for one trajectory on one thread at order 10 (batch 8, largest error 1e-8), measured on a Zen 5: this 0.72,
compact mode 1.2; angle as state with sin and cos 0.73; resting angle as state with cos^3 0.77; both 0.79; arclength a
as the independent variable 0.90. Sorted by load and length, as below, lanes end together (unsorted 0.85). Whiskers that
are straight at rest have a system of their own, without k and m.
"""

import json
import sys
from math import exp
from multiprocessing import get_context
from time import perf_counter

import heyoka
import numpy as np
from ensemble import Ensemble

RUNS = 15
# Batch sizes: one vector of the processor, and two interleaved.
BATCHES = [vectors * heyoka.recommended_simd_size() for vectors in (1, 2)]
# The tolerance only determines the order, ceil(1 - ln(tolerance)/2), so one tolerance per order is enough.
TOLERANCES = [1.5 * exp(2 - 2 * order) for order in range(5, 15)]
fork = get_context("fork")


def system(is_bent):
    names = ("C", "S", "x", "y", "G", "theta_s", "x_s", "y_s", "theta_p", "x_p", "y_p", "k", "m")
    C, S, x, y, G, theta_s, x_s, y_s, theta_p, x_p, y_p, k, m = heyoka.make_vars(*names)
    beta, p = heyoka.par[0], heyoka.par[1]
    lever = G * x
    K = k + p * lever if is_bent else p * lever
    resting = [(k, beta * k + 3 * (k * m)), (m, beta * m - k * k + 2 * (m * m))] if is_bent else []
    return [
        (C, beta * C + K * S),
        (S, beta * S - K * C),
        (x, C),
        (y, S),
        (G, -3 * beta * G),
        (theta_s, -p * (G * x_s)),
        (x_s, -(S * theta_s)),
        (y_s, C * theta_s),
        (theta_p, -lever - p * (G * x_p)),
        (x_p, -(S * theta_p)),
        (y_p, C * theta_p),
        *resting,
    ]


def start(ensemble):
    """Returns states, parameters and end times, with one column per trajectory."""
    beta, rho, t = ensemble.taper * ensemble.s, ensemble.radius, ensemble.slope()
    curvature = 2 * ensemble.bend * ensemble.s / np.hypot(1, t) ** 3
    zero, one = np.zeros_like(rho), np.ones_like(rho)
    derivatives = [-curvature, one, zero, zero, zero, zero]
    resting = [rho * curvature, rho * curvature * t] if ensemble.is_bent else []
    states = np.array([rho, zero, zero, zero, one, *derivatives, *resting])
    straight = np.where(beta > 0, beta, 1)
    ends = np.where(beta > 0, -np.log1p(-beta) / straight, 1)
    return states, np.array([beta, ensemble.force * ensemble.s**2 / rho**3]), ends


def error(ensemble, states):
    C, S, x, y, _, theta_s, x_s, y_s, theta_p, x_p, y_p = states[:11]
    base = x + 1j * y
    by_s = ((x_s + 1j * y_s) / base - 1j * theta_s) / ensemble.s
    by_p = (x_p + 1j * y_p) / base - 1j * theta_p
    return ensemble.error(ensemble.s * base * (C - 1j * S), by_s, by_p * ensemble.s**2 / ensemble.radius**3)


def solve(integrator, batches, states=None):
    """Returns the seconds to integrate all batches into `states`; without `states`, those of the Python loop alone."""
    begin = np.zeros(integrator.batch_size)
    state, pars = integrator.state, integrator.pars
    spare = np.empty_like(state)
    before = perf_counter()
    for i, (start, parameters, ends) in enumerate(zip(*batches)):
        state[:], pars[:] = start, parameters
        integrator.set_time(begin)
        if states is None:
            spare[:] = state
        else:
            integrator.propagate_until(ends)
            states[i] = state
    return perf_counter() - before


def work(tolerance, scenes, barrier, results, place):
    """Runs one process: its batches of each scene, RUNS times, each at the same time as the other processes."""
    solvers = []
    for is_bent, batches in scenes:
        shape = batches[0].shape[1:]
        ones = np.ones(shape), np.ones((2, shape[1]))
        options = {"tol": tolerance, "compact_mode": False, "fast_math": True, "force_avx512": True}
        integrator = heyoka.taylor_adaptive_batch(system(is_bent), ones[0], pars=ones[1], **options)
        solvers.append((integrator, batches, np.empty_like(batches[0])))
    for solver in solvers:
        solve(*solver)
    seconds = []
    for _ in range(RUNS):
        barrier.wait()
        whole = sum(solve(*solver) for solver in solvers)
        barrier.wait()
        seconds.append((whole, sum(solve(integrator, batches) for integrator, batches, _ in solvers)))
    results.put((place, [states for _, _, states in solvers], seconds, solvers[0][0].order))


def row(scenes, threads, batch, tolerance):
    """Returns cost and error of the scenes at one tolerance, without the time of the Python loop."""
    batches = [[cut(array, batch) for array in start(ensemble)] for ensemble in scenes]
    barrier, results = fork.Barrier(threads), fork.Queue()
    kinds = [ensemble.is_bent for ensemble in scenes]
    shares = [
        [(kind, [array[place::threads] for array in each]) for kind, each in zip(kinds, batches)]
        for place in range(threads)
    ]
    processes = [
        fork.Process(target=work, args=(tolerance, share, barrier, results, place))
        for place, share in enumerate(shares)
    ]
    for process in processes:
        process.start()
    states, net, python = [np.empty_like(each[0]) for each in batches], [], []
    for _ in processes:
        place, found, seconds, order = results.get()
        for whole, part in zip(states, found):
            whole[place::threads] = part
        net.append([whole - loop for whole, loop in seconds])
        python.append([loop for _, loop in seconds])
    for process in processes:
        process.join()
    columns = (np.moveaxis(each, 1, 0).reshape(each.shape[1], -1) for each in states)
    errors = np.concatenate([error(*pair) for pair in zip(scenes, columns)])
    # A run takes as long as its slowest process.
    net, python = (1e6 * min(map(max, zip(*times))) / errors.size for times in (net, python))
    return {
        "threads": threads,
        "batch": batch,
        "tolerance": tolerance,
        "order": order,
        "microseconds": net,
        "microseconds_of_python": python,
        "error_max": errors.max(),
        "error_99": np.quantile(errors, 0.99),
    }


def cut(array, batch):
    """Returns the columns of `array` in batches along the first axis."""
    columns = array.reshape(*array.shape[:-1], -1, batch)
    return np.ascontiguousarray(np.moveaxis(columns, -2, 0))


def main():
    scenes = Ensemble(sys.argv[1]).scenes()
    for ensemble in scenes:
        load = ensemble.force * (ensemble.s / ensemble.radius) ** 2
        # The number of steps increases with the load and, less, with the length.
        ensemble.sort(load + 0.4 * start(ensemble)[2])
    rows = [row(scenes, *case) for case in cases()]
    json.dump({"version": heyoka.__version__, "rows": rows}, sys.stdout)


def cases():
    return [(threads, batch, tolerance) for threads in (1, 2) for batch in BATCHES for tolerance in TOLERANCES]


if __name__ == "__main__":
    main()
