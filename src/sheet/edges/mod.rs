//! The edges of the stable sheet, sampled: the fold at every column, the tip from first touch to the corner.

mod bracket;
pub mod crossings;
pub mod edge_newton;
pub mod tip_edge;

use crate::numerics::lobatto::{LOADS, PARTS};
use crate::numerics::nearest_turn;
use crate::rod::{Rest, Rod, arclength};
use crate::sheet::edges::tip_edge::{TipLine, Turn};
use crate::sheet::fold::FoldPoint;
use crate::sheet::fold::contact_nodes::Columns;
use crate::sheet::fold::predictor::FoldLine;
use crate::sheet::lattice::Lattice;
use crate::sheet::lattice::directions;
use crate::shooting::batch::{InitialCondition, Method, shoot, shoot_padded};
use crate::shooting::{First, Nystrom8, Second, SecondVariation, ShootingMap};
use glam::DVec2;

/// The Newton step, relative to the distance of the samples, after which an extremum is known: its square is left.
const LAST_STEP: f64 = 1e-7;

/// A computed point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The column, or the part of the load at the corner.
    pub place: f64,
    /// `tau` of the contact.
    pub tau: f64,
    /// Signed load.
    pub load: f64,
    /// `ln D`.
    pub ln_distance: f64,
    /// Direction of the pole, continuous from first touch.
    pub phi: f64,
}

impl Sample {
    fn new(place: f64, tau: f64, load: f64, map: &ShootingMap, phi_near: f64) -> Self {
        Self {
            place,
            tau,
            load,
            ln_distance: map.pole.length().ln(),
            phi: nearest_turn(map.pole.to_angle(), phi_near),
        }
    }
}

/// The sampled edges of a sheet.
#[derive(Clone, Debug)]
pub struct Edges {
    /// From the base to the corner.
    pub fold: Vec<Sample>,
    /// The same between the samples.
    pub fold_line: FoldLine,
    /// Whether the distance grows along the fold from the base to the tip, so that no row crosses it twice. Where the
    /// first fold jumps from contact to contact, there is more of it than the samples show.
    pub fold_grows: bool,
    /// From first touch to the corner.
    pub tip: Vec<Sample>,
    /// The same between the samples.
    pub tip_line: TipLine,
    /// How far, in `tau`, the integration puts the tip of the resting whisker from where its shape at rest has it.
    pub tip_error: f64,
}

impl Edges {
    /// Samples both edges of a whisker that is at `rest` without load; `lattice` knows the whole turns of the pole's direction.
    pub fn new(
        method: Method,
        rod: &Rod,
        rest: &Rest,
        columns: &Columns,
        lattice: &Lattice,
    ) -> Self {
        let fold: Vec<Sample> = columns.folds[..=columns.tip]
            .iter()
            .zip(lattice.phi_at_fold())
            .enumerate()
            .map(|(i, (fold, phi))| {
                Sample::new(i as f64, fold.tau, fold.load, &fold.variation.map, phi)
            })
            .collect();
        let (mut tip, tip_line, at_touch) = tip_samples(method, rod, &columns.folds[columns.tip]);
        let (tip_at_rest, _) = rest.at_arclength(arclength(rod, rod.tau_tip()));
        let pole = rest.pole_at_distance(tip_at_rest.length()).length();
        tip.extend(fold.last().map(|corner| Sample {
            place: 1.0,
            ..*corner
        }));
        Self {
            fold,
            fold_line: FoldLine::new(columns, lattice.phi_at_fold()),
            fold_grows: (0..columns.tip).all(|column| columns.grow_after(column)),
            tip_error: ((at_touch.pole.length() / pole).ln() / at_touch.by_tau.x).abs(),
            tip,
            tip_line,
        }
    }
}

/// The tip edge from first touch to before the `corner`, with its extrema of distance among the samples, and the line through the
/// others and the corner, and first touch.
fn tip_samples(
    method: Method,
    rod: &Rod,
    corner: &FoldPoint,
) -> (Vec<Sample>, TipLine, ShootingMap) {
    let condition = |load| InitialCondition {
        rod: *rod,
        tau: corner.tau,
        load,
    };
    let loads = PARTS[..LOADS - 1].iter().map(|part| part * corner.load);
    let conditions: Vec<InitialCondition> = loads.map(condition).collect();
    let mut maps = shoot_padded::<Nystrom8, First>(method, &conditions);
    maps.push(corner.variation.map);
    let phis = directions(corner.load, maps.iter());
    let line = TipLine::new(corner.tau, corner.load, &maps, &phis);
    let turns = line.turns();
    let mut samples: Vec<Sample> = Vec::new();
    for (m, condition) in conditions.iter().enumerate() {
        let sample = |load: f64, map: &ShootingMap| {
            Sample::new(load / corner.load, corner.tau, load, map, phis[m])
        };
        samples.push(Sample {
            place: PARTS[m],
            ..sample(condition.load, &maps[m])
        });
        for turn in turns.iter().filter(|turn| turn.after == m) {
            let (load, map) = extremum(method, *condition, turn);
            samples.push(sample(load, &map));
        }
    }
    (samples, line, maps[0])
}

/// The load at which the distance turns with the contact at the tip, and the map there: mostly the line along the tip knows the
/// `turn`, and one trajectory with it all the rest.
fn extremum(method: Method, at_tip: InitialCondition, turn: &Turn) -> (f64, ShootingMap) {
    let (near, [from, to], by_load_load) = (turn.load, turn.between, turn.bend);
    let at = |load| shoot::<Nystrom8, First>(method, &[InitialCondition { load, ..at_tip }])[0];
    let map = at(near);
    let step = -map.by_load.x / by_load_load.x;
    if step.abs() <= LAST_STEP * (to - from).abs() {
        let here = SecondVariation {
            map,
            by_load_load,
            ..SecondVariation::default()
        };
        return (near + step, here.extrapolated(DVec2::new(0.0, step)).map);
    }
    let load = bracketed_extremum(
        method,
        InitialCondition {
            load: from,
            ..at_tip
        },
        to,
        near,
    );
    (load, at(load))
}

/// The same load by Newton's method from `near` and second derivatives, bisecting where a step would leave the bracket.
fn bracketed_extremum(method: Method, from: InitialCondition, to: f64, near: f64) -> f64 {
    let at = |load: f64| shoot::<Nystrom8, Second>(method, &[InitialCondition { load, ..from }])[0];
    let (mut low, mut high) = (from.load, to);
    let mut load = near;
    let mut falling_at_low = None;
    for _ in 0..60 {
        let here = at(load);
        let slope = here.map.by_load.x;
        let newton = load - slope / here.by_load_load.x;
        let inside = (newton - low) * (newton - high) < 0.0;
        if inside && (newton - load).abs() <= LAST_STEP * (to - from.load).abs() {
            return newton;
        }
        let falls = *falling_at_low.get_or_insert_with(|| at(from.load).map.by_load.x < 0.0);
        if (slope < 0.0) == falls {
            low = load;
        } else {
            high = load;
        }
        let next = if inside { newton } else { 0.5 * (low + high) };
        if next == load {
            return next;
        }
        load = next;
    }
    load
}
