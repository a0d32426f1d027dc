//! Hard cases by name.

use super::case::Case;

/// Straight cylinder at a point contact.
const PLAIN: Case = Case {
    length_mm: 20.0,
    taper: 0.0,
    bend: 0.0,
    pole: 0.0,
    friction: 0.0,
    tip_to_base: 1.0,
    stretch: 1.0,
    compliance: 0.0,
    rows: Vec::new(),
    pushes_deg: Vec::new(),
    distances: Vec::new(),
};

/// Push angles in degrees, from a trillionth of a degree to a whole turn.
const PUSHES: [f64; 14] =
    [1e-12, 1e-9, 1e-6, 1e-3, 0.1, 2.0, 10.0, 30.0, 60.0, 100.0, 150.0, 200.0, 280.0, 360.0];

/// Distances in whisker lengths, from next to the base to beyond the reach.
const DISTANCES: [f64; 12] = [0.02, 0.05, 0.12, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 1.0, 1.05, 1.3];

/// All named cases, with the grid of [`PUSHES`] on both sides and [`DISTANCES`].
pub fn named() -> Vec<(&'static str, Case)> {
    let cone = Case { taper: 0.95, bend: 0.4, pole: 0.0125, ..PLAIN };
    let cases = [
        ("cylinder", PLAIN),
        ("taper 1e-12", Case { taper: 1e-12, ..PLAIN }),
        ("taper 1 - 1e-3", Case { taper: 1.0 - 1e-3, ..cone.clone() }),
        ("taper 1 - 1e-6", Case { taper: 1.0 - 1e-6, ..cone.clone() }),
        ("perfect cone", Case { taper: 1.0, ..cone.clone() }),
        ("straight perfect cone", Case { taper: 1.0, ..PLAIN }),
        ("A* 1e-9", Case { bend: 1e-9, ..cone.clone() }),
        ("A* 1.5", Case { bend: 1.5, ..cone.clone() }),
        ("cylinder, A* 1.5", Case { bend: 1.5, ..PLAIN }),
        ("point pole", Case { pole: 0.0, ..cone.clone() }),
        ("pole 1e-9", Case { pole: 1e-9, ..cone.clone() }),
        ("pole 0.1", Case { pole: 0.1, ..cone.clone() }),
        ("friction 1", Case { friction: 1.0, ..cone.clone() }),
        ("cylinder, friction 1", Case { friction: 1.0, ..PLAIN }),
        ("soft tip", Case { tip_to_base: 0.1, ..cone.clone() }),
        ("cylinder, soft tip", Case { tip_to_base: 0.1, ..PLAIN }),
        ("stiff tip", Case { tip_to_base: 10.0, ..cone.clone() }),
        ("stiff tip, friction 1", Case { tip_to_base: 10.0, friction: 1.0, ..cone.clone() }),
        ("cylinder, stiff tip, friction 0.5", Case { tip_to_base: 10.0, friction: 0.5, ..PLAIN }),
        ("soft follicle", Case { compliance: 0.3, ..cone.clone() }),
        ("cylinder, soft follicle, friction 0.5", Case { compliance: 0.2, friction: 0.5, ..PLAIN }),
        (
            "thin shaft",
            Case {
                rows: vec![[0.0, 1.0], [0.25, 0.33], [0.5, 0.13], [0.75, 0.07], [1.0, 0.03]],
                ..cone.clone()
            },
        ),
        (
            "thick shaft, stretch 1.03",
            Case {
                rows: vec![[0.0, 1.0], [0.25, 1.5], [0.5, 1.3], [0.75, 0.8], [1.0, 0.05]],
                stretch: 1.03,
                ..cone.clone()
            },
        ),
    ];
    cases.into_iter().map(|(name, case)| (name, with_grid(case))).collect()
}

fn with_grid(mut case: Case) -> Case {
    let cf = PUSHES.iter().rev().map(|push| -push);
    case.pushes_deg = cf.chain([0.0]).chain(PUSHES).collect();
    // The base must be outside the pole.
    let outside = DISTANCES.into_iter().filter(|d| *d > case.pole);
    case.distances = outside.collect();
    case
}
