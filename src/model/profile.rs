//! A trajectory seen at places along the whisker.

use super::rhs::{Bent, Graded, RodSystem, Section, Shape, State};
use super::{Dopri8, Resolution, Rest, Rod, Scales, Start, arclength, integrate};
use glam::DVec2;

/// The whisker at one place, as seen from the contact, in axes whose second one is along the force; lengths in whisker
/// lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Arclength from the base.
    pub arclength: f64,
    /// Position.
    pub position: DVec2,
    /// Unit tangent.
    pub tangent: DVec2,
    /// `dtheta/ds`.
    pub curvature: f64,
    /// Bending moment, in `E I_base/L_w`; 0 beyond the contact.
    pub moment: f64,
}

/// The places at growing arclengths `at` of the whisker in contact at `tau` under `load`; beyond the contact it keeps
/// its rest shape.
#[must_use]
pub fn profile(rod: &Rod, tau: f64, load: f64, resolution: Resolution, at: &[f64]) -> Vec<Place> {
    let contact = arclength(rod, tau);
    let deflected = at.partition_point(|s| *s < contact);
    let start = Start::new(rod, tau, load);
    let mut state: State<f64, Bent<f64>, 0> = (
        [start.cos, start.sin],
        ([start.tangent.x, start.tangent.y, 0.0, 0.0], []),
    );
    let mut from = tau;
    // Parts of a trajectory take their shares of the steps that the whole would take.
    let part = |length: f64| {
        let share = f64::from(resolution.steps(rod, tau)) * length / tau;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of a small number"
        )]
        let share = share.ceil() as u32;
        share.max(1)
    };
    let mut places: Vec<Place> = at[..deflected]
        .iter()
        .rev()
        .map(|s| {
            let to = rod.tau(*s);
            state = advance(rod, start.force, part(from - to), (from, to), state);
            from = to;
            loaded(rod, *s, start.force, &state)
        })
        .collect();
    places.reverse();
    places.extend(at[deflected..].iter().map(|s| free(rod, contact, *s)));
    places
}

/// Integrates `state` from one `tau` back to a smaller one.
fn advance(
    rod: &Rod,
    force: f64,
    steps: u32,
    (from, to): (f64, f64),
    state: State<f64, Bent<f64>, 0>,
) -> State<f64, Bent<f64>, 0> {
    let h = (from - to) / f64::from(steps);
    let rho = rod.radius(from);
    let section = Section {
        rho,
        inverse_cube: 1.0 / (rho * rho * rho),
        arclength: arclength(rod, from),
    };
    let system = RodSystem {
        force,
        intrinsic: Bent {
            twice_bend: 2.0 * rod.bend,
        },
        material: Graded {
            gradient: rod.gradient,
        },
    };
    let scales = Scales::tapered::<Dopri8>(rod.taper, h);
    integrate::<Dopri8, f64, _, _, Shape, 0>(&system, &scales, section, h, steps, state)
}

fn loaded(rod: &Rod, s: f64, force: f64, state: &State<f64, Bent<f64>, 0>) -> Place {
    let ([cos, _], ([c, sin, x, y], [])) = *state;
    let moment = -force * x;
    let stiffness = rod.radius(rod.tau(s)).powi(4) * rod.modulus(s);
    Place {
        arclength: s,
        position: DVec2::new(x, y),
        tangent: DVec2::new(c, sin),
        curvature: 2.0 * rod.bend * cos.powi(3) + moment / stiffness,
        moment,
    }
}

fn free(rod: &Rod, contact: f64, s: f64) -> Place {
    let rest = Rest::new(rod);
    let (from, axis) = rest.at_arclength(contact);
    let (to, tangent) = rest.at_arclength(s);
    let turn = rod.contact_tangent().rotate(DVec2::new(axis.x, -axis.y));
    let slope = rest.slope_at(s);
    Place {
        arclength: s,
        position: turn.rotate(to - from),
        tangent: turn.rotate(tangent),
        curvature: 2.0 * rod.bend / slope.hypot(1.0).powi(3),
        moment: 0.0,
    }
}
