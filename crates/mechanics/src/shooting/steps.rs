//! Where the steps of a trajectory start: what a shader needs of it to integrate others beside it.

use crate::rod::{Rest, Rod, arclength};
use crate::shooting::intrinsic::TERMS;
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
    /// Position, in whisker lengths.
    pub position: DVec2,
    /// How far bending has turned the rod since the contact.
    pub bent: f64,
    /// cos and sin of the tangent of a parabola at rest, in its own frame.
    pub rest: DVec2,
    /// How far that tangent turns along the step: coefficients of the powers, from the first on, of the arclength toward the base
    /// over the radius at the start. 0 where the whisker is no parabola at rest.
    pub rest_turn: [f64; TERMS],
}

/// Appends to `starts` where each of the `steps` starts that the trajectory of a uniform cone takes from the contact at `tau` under
/// `load` to the base; how far bending has turned the rod there.
pub fn step_starts(rod: &Rod, tau: f64, load: f64, steps: u32, starts: &mut Vec<StepStart>) -> f64 {
    let straight = (DVec2::X, [0.0; TERMS]);
    match rod.spiral {
        Some([at_base, slope]) => {
            let spiral = Spiral { at_base, slope };
            follow(rod, (tau, load), steps, spiral, (), starts, |_, ()| {
                straight
            })
        }
        None if rod.bend == 0.0 => {
            follow(rod, (tau, load), steps, Straight, (), starts, |_, ()| {
                straight
            })
        }
        None => {
            let bent = Bent {
                twice_bend: 2.0 * rod.bend,
            };
            let at_contact = Rest::parabola_tangent(rod, arclength(rod, tau)).to_array();
            let at_rest = |section: &Section<f64>, tangent| {
                let course = bent.course(section, tangent);
                (DVec2::from_array(tangent), course.coefficients())
            };
            follow(rod, (tau, load), steps, bent, at_contact, starts, at_rest)
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
    at_rest: impl Fn(&Section<f64>, I::State) -> (DVec2, [f64; TERMS]),
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
        let (rest, ([cos, sin, x, y, bent], _)) = state;
        let (rest, rest_turn) = at_rest(&section, rest);
        starts.push(StepStart {
            radius: section.rho,
            arclength: section.arclength,
            tangent: DVec2::new(cos, sin),
            position: DVec2::new(x, y),
            bent,
            rest,
            rest_turn,
        });
        state = integrate::<Nystrom8, f64, _, _, Shape>(&system, &scales, section, 1, state);
        section = section.at(scales.end());
    }
    let (_, ([.., bent], _)) = state;
    bent
}
