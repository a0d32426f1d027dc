"""Contact of a rod with a pole without friction: a penalty on a smooth curve through the nodes."""

import numpy as np
from numba import njit


@njit(cache=True)
def weights(u, segment, last):
    """Returns the first of four nodes, and their weights and derivatives at `u` in [0, 1] of a segment (Catmull-Rom).

    At the tip the tangent is one-sided, of second order.
    """
    w, dw = np.zeros(4), np.zeros(4)
    h00, h10, h01, h11 = 2 * u**3 - 3 * u**2 + 1, u**3 - 2 * u**2 + u, 3 * u**2 - 2 * u**3, u**3 - u**2
    d00, d10, d01, d11 = 6 * u**2 - 6 * u, 3 * u**2 - 4 * u + 1, 6 * u - 6 * u**2, 3 * u**2 - 2 * u
    for out, (a, b, c, d) in ((w, (h00, h10, h01, h11)), (dw, (d00, d10, d01, d11))):
        out[0] = -b / 2
        out[1] = a
        out[2] = c + b / 2
        if segment + 1 < last:
            out[1] -= d / 2
            out[3] = d / 2
        else:
            out[0] += d / 2
            out[1] -= 2 * d
            out[2] += 1.5 * d
    return w, dw


@njit(cache=True)
def closest(position, segment, u, x, y, last):
    """Returns distance, place in the segment, and weights of the closest point of one segment to (x, y)."""
    for _ in range(8):
        w, dw = weights(u, segment, last)
        px, py, tx, ty = -x, -y, 0.0, 0.0
        for j in range(4 if segment + 1 < last else 3):
            node = segment - 1 + j
            px += w[j] * position[0, node]
            py += w[j] * position[1, node]
            tx += dw[j] * position[0, node]
            ty += dw[j] * position[1, node]
        # The curvature times the distance is small, so that this is nearly Newton's method.
        step = (px * tx + py * ty) / (tx * tx + ty * ty)
        new = min(max(u - step, 0.0), 1.0)
        if abs(new - u) < 1e-13:
            break
        u = new
    return np.hypot(px, py), u, w, px, py


@njit(cache=True)
def push(position, external_forces, stiffness, x, y, radius):
    """Adds the pole's force to the nodes. Returns force, place in segments from node 0, and direction of the force.

    `stiffness` has a value for each node. The force is zero without contact.
    """
    last = position.shape[1] - 1
    nearest, least = 1, np.inf
    for node in range(1, last + 1):
        apart = np.hypot(position[0, node] - x, position[1, node] - y)
        if apart < least:
            nearest, least = node, apart
    if least > radius + np.hypot(position[0, 2] - position[0, 1], position[1, 2] - position[1, 1]):
        return 0.0, 0.0, 0.0, 0.0
    best, place, chosen = np.inf, 0.0, 1
    bw, bx, by = np.zeros(4), 0.0, 0.0
    for segment in (nearest - 1, nearest):
        if segment < 1 or segment >= last:
            continue
        apart, u, w, px, py = closest(position, segment, 0.5, x, y, last)
        if apart < best:
            best, place, chosen, bw, bx, by = apart, segment + u, segment, w, px, py
    if best >= radius:
        return 0.0, 0.0, 0.0, 0.0
    share = place - chosen
    force = ((1 - share) * stiffness[chosen] + share * stiffness[chosen + 1]) * (radius - best)
    for j in range(4 if chosen + 1 < last else 3):
        external_forces[0, chosen - 1 + j] += bw[j] * force * bx / best
        external_forces[1, chosen - 1 + j] += bw[j] * force * by / best
    return force, place, bx / best, by / best
