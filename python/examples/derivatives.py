"""Push angles at detachment as functions of JAX and PyTorch, with exact derivatives.

`for_jax` and `for_torch` return a function of the distance and of named parameters, all broadcast against each other. Its derivatives are
of first order: forward and reverse mode in JAX, reverse mode in PyTorch. Run as a program, this file checks each of the two libraries that
is installed.
"""

from importlib.util import find_spec

import numpy as np
import whiskmap as wm


def for_jax(scene, names, side="cb", quantity="push_angle_deg"):
    """Return `function(distance_mm, *values)` of JAX arrays: `jit`, `vmap`, `grad` and `jvp` apply.

    The values are float64, so ``jax.config.update("jax_enable_x64", True)`` must come first.
    """
    import jax
    import jax.numpy as jnp

    variables = ("distance_mm", *names)

    def call(of_end, ending, *inputs):
        shape = jnp.broadcast_shapes(*(own.shape for own in inputs)) + ending

        def compute(distance_mm, *values):
            end = wm.detachment(scene, distance_mm=distance_mm, side=side, jac=variables, **dict(zip(names, values)))
            return of_end(end)

        result = jax.ShapeDtypeStruct(shape, jnp.float64)
        return jax.pure_callback(compute, result, *inputs, vmap_method="broadcast_all")

    @jax.custom_jvp
    def function(*inputs):
        return call(lambda end: getattr(end, quantity), (), *inputs)

    @function.defjvp
    def derivative(inputs, tangents):
        by = call(lambda end: end.jac[quantity], (len(variables),), *inputs)
        return function(*inputs), sum(by[..., index] * tangent for index, tangent in enumerate(tangents))

    return lambda *inputs: function(*(jnp.asarray(own, jnp.float64) for own in inputs))


def for_torch(scene, names, side="cb", quantity="push_angle_deg"):
    """Return `function(distance_mm, *values)` of tensors on the CPU in float64: `backward` applies."""
    import torch

    variables = ("distance_mm", *names)

    class Function(torch.autograd.Function):
        @staticmethod
        def forward(context, *inputs):
            distance_mm, *values = (own.detach().numpy() for own in inputs)
            end = wm.detachment(scene, distance_mm=distance_mm, side=side, jac=variables, **dict(zip(names, values)))
            context.save_for_backward(torch.from_numpy(end.jac[quantity]))
            return torch.from_numpy(getattr(end, quantity))

        @staticmethod
        @torch.autograd.function.once_differentiable
        def backward(context, gradient):
            [by] = context.saved_tensors
            return tuple((gradient[..., None] * by).unbind(-1))

    def function(*inputs):
        tensors = (torch.as_tensor(own, dtype=torch.float64) for own in inputs)
        return Function.apply(*torch.broadcast_tensors(*tensors))

    return function


NAMES = ("taper", "parabola_per_mm")
DISTANCE, TAPER, PARABOLA = np.array([12.0, 15.66]), 0.95, 0.02


def expected(scene):
    """Push angles at DISTANCE, and their derivatives by taper, from the package alone."""
    end = wm.detachment(scene, distance_mm=DISTANCE, side="cb", taper=TAPER, parabola_per_mm=PARABOLA, jac=True)
    return end.push_angle_deg, end.jac["push_angle_deg"][:, 0]


def check_jax(scene):
    import jax
    from jax.test_util import check_grads

    jax.config.update("jax_enable_x64", True)
    function = for_jax(scene, NAMES)
    angles, by_taper = expected(scene)
    np.testing.assert_allclose(jax.jit(function)(DISTANCE, TAPER, PARABOLA), angles)
    np.testing.assert_allclose(jax.jacfwd(function, 1)(DISTANCE, TAPER, PARABOLA), by_taper)
    of_one = jax.vmap(jax.grad(function, 1), in_axes=(0, None, None))
    np.testing.assert_allclose(of_one(DISTANCE, TAPER, PARABOLA), by_taper)
    check_grads(function, (DISTANCE, TAPER, PARABOLA), order=1, modes=["fwd", "rev"], eps=1e-5, rtol=1e-5)


def check_torch(scene):
    import torch

    function = for_torch(scene, NAMES)
    angles, by_taper = expected(scene)
    inputs = [torch.tensor(own, dtype=torch.float64, requires_grad=True) for own in (DISTANCE, TAPER, PARABOLA)]
    found = function(*inputs)
    np.testing.assert_allclose(found.detach(), angles)
    found.sum().backward()
    np.testing.assert_allclose(inputs[1].grad, by_taper.sum())
    assert torch.autograd.gradcheck(function, inputs, eps=1e-5, atol=1e-4)


if __name__ == "__main__":
    cone = wm.Scene(
        whisker=wm.Whisker(length_mm=20, base_radius_um=30, taper=TAPER, youngs_modulus_gpa=3, parabola_per_mm=PARABOLA),
        pole=wm.Pole(radius_mm=0.25),
        grid=wm.Grid(push_angle_deg=[10], distance_mm=[10]),
    )
    for library, check in (("jax", check_jax), ("torch", check_torch)):
        if find_spec(library) is None:
            print(f"{library}: not installed, not checked")
        else:
            check(cone)
            print(f"{library}: checked")
