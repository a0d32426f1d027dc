//! The sets of effects that there are kernels for.
#![allow(dead_code, reason = "each test program uses its own share")]

use whiskmap::engine;
use whiskmap::mechanics::rod::Effects;

/// Every set of effects. A profile tapers, whatever `taper` says.
pub fn all() -> impl Iterator<Item = Effects> {
    let rest =
        [(false, false, false), (true, false, false), (false, true, false), (false, false, true)];
    let stiffness = [
        (false, false, false),
        (true, false, false),
        (false, true, false),
        (true, true, false),
        (true, false, true),
        (true, true, true),
    ];
    rest.into_iter().flat_map(move |(curvature, spiral, polynomial)| {
        stiffness.into_iter().map(move |(taper, gradient, profile)| Effects {
            taper,
            curvature,
            spiral,
            polynomial,
            gradient,
            profile,
        })
    })
}

/// Those that the GPU has kernels for.
pub fn on_gpu() -> impl Iterator<Item = Effects> {
    all().filter(|effects| engine::on_gpu(*effects).is_ok())
}
