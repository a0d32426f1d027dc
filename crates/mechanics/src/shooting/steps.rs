//! Where the steps of a trajectory start: what a shader needs of it to integrate others beside it.

use crate::rod::{Rest, Rod, arclength};
use crate::shooting::{
    Bent, Intrinsic, Nystrom8, RodSystem, Scales, Section, Shape, Spiral, State, Straight, Uniform,
    integrate,
};
use glam::DVec2;

/// The whisker where a step starts, as seen from the contact, in axes whose second one is along the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepStart {
    /// Radius over the base radius.
    pub radius: f64,
    /// Arclength from the base, in whisker lengths.
    pub arclength: f64,
    /// Unit tangent.
    pub tangent: DVec2,
    /// Position across the force, in whisker lengths.
    pub across: f64,
    /// How far bending has turned the rod since the contact.
    pub bent: f64,
    /// cos and sin of the tangent of a parabola at rest, in its own frame; of the first axis where the whisker is none.
    pub rest: DVec2,
}

/// Appends to `starts` where each of the `steps` starts that the trajectory of a uniform cone takes from the contact at `tau` under
/// `load` to the base; how far bending has turned the rod there.
pub fn step_starts(rod: &Rod, tau: f64, load: f64, steps: u32, starts: &mut Vec<StepStart>) -> f64 {
    match rod.spiral {
        Some([at_base, slope]) => {
            let spiral = Spiral { at_base, slope };
            follow(rod, (tau, load), steps, spiral, (), starts, |()| DVec2::X)
        }
        None if rod.bend == 0.0 => {
            follow(rod, (tau, load), steps, Straight, (), starts, |()| DVec2::X)
        }
        None => {
            let bent = Bent {
                twice_bend: 2.0 * rod.bend,
            };
            let at_contact = Rest::parabola_tangent(rod, arclength(rod, tau)).to_array();
            follow(
                rod,
                (tau, load),
                steps,
                bent,
                at_contact,
                starts,
                DVec2::from_array,
            )
        }
    }
}

fn follow<I: Intrinsic<f64>>(
    rod: &Rod,
    (tau, load): (f64, f64),
    steps: u32,
    intrinsic: I,
    rest: I::State,
    starts: &mut Vec<StepStart>,
    tangent_of: impl Fn(I::State) -> DVec2,
) -> f64 {
    let radius = rod.radius(tau);
    let system = RodSystem {
        force: load * radius * radius,
        intrinsic,
        material: Uniform,
    };
    let scales = Scales::tapered::<Nystrom8>(rod.taper, tau / f64::from(steps));
    let mut section = Section {
        rho: radius,
        inverse_cube: 1.0 / (radius * radius * radius),
        arclength: arclength(rod, tau),
    };
    let tangent = rod.contact_tangent();
    let at_contact = [tangent.x, tangent.y, 0.0, 0.0, 0.0];
    let mut state: State<f64, I, Shape> = (rest, (at_contact, ((), ((), ()))));
    for _ in 0..steps {
        let (rest, ([cos, sin, across, _, bent], _)) = state;
        starts.push(StepStart {
            radius: section.rho,
            arclength: section.arclength,
            tangent: DVec2::new(cos, sin),
            across,
            bent,
            rest: tangent_of(rest),
        });
        state = integrate::<Nystrom8, f64, _, _, Shape>(&system, &scales, section, 1, state);
        section = section.at(scales.end());
    }
    let (_, ([.., bent], _)) = state;
    bent
}
