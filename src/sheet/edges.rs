//! The edges of the stable sheet, sampled: the fold at every column, the tip from first touch to the corner.

use super::columns::Columns;
use super::lattice::Lattice;
use super::polynomial::{NODES, Polynomial, stencil};
use super::rows::Row;
use crate::model::batch::{Launch, Method, land, land_in_company};
use crate::model::{First, Landing, Nystrom8, Rod, Second, nearest_turn};

/// Samples along the tip edge; the distance has at most a few extrema there.
const TIP_SAMPLES: usize = 32;

/// Relative slack with which a distance counts as reached, so that a whisker whose resting tip just touches
/// the pole does touch it, whatever the rounding.
pub const REACH_SLACK: f64 = 1e-12;

/// The Newton step, relative to the distance of the samples, after which an extremum is known: its square is left.
const LAST_STEP: f64 = 1e-7;

/// How much `ln q` of the fold changes from column to column at the least where it jumps; with friction, from 29 to 15. With columns
/// 0.25 apart, at 0.4 one of the 2,000 random whiskers of the tests kept a cell in doubt.
pub const JUMP: f64 = 0.25;

/// A computed point of an edge.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
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
    fn new(tau: f64, load: f64, landing: &Landing, phi_near: f64) -> Self {
        Self {
            tau,
            load,
            ln_distance: landing.pole.length().ln(),
            phi: nearest_turn(landing.pole.to_angle(), phi_near),
        }
    }
}

/// The sampled edges of a sheet.
#[derive(Clone, Debug)]
pub struct Edges {
    /// From the base to the corner.
    pub fold: Vec<Sample>,
    /// From first touch to the corner.
    pub tip: Vec<Sample>,
}

impl Edges {
    /// Samples both edges; `lattice` knows the whole turns of the pole's direction.
    pub fn new(method: Method, rod: &Rod, columns: &Columns, lattice: &Lattice) -> Self {
        let mut tip = tip_samples(method, rod, columns);
        let fold: Vec<Sample> = columns.folds[..=columns.tip]
            .iter()
            .zip(lattice.phi_at_fold())
            .map(|(fold, phi)| Sample::new(fold.tau, fold.load, &fold.landing.landing, phi))
            .collect();
        tip.extend(fold.last());
        Self { fold, tip }
    }

    /// Whether the distance grows along the fold from the base to the tip, so that no row crosses it twice. Where the
    /// first fold jumps from contact to contact, there is more of it than the samples show.
    #[must_use]
    pub fn fold_grows(&self) -> bool {
        let q = |s: &Sample| s.load.abs() * s.tau * s.tau;
        self.fold.windows(2).all(|pair| {
            let jump = (q(&pair[1]) / q(&pair[0])).ln().abs();
            pair[0].ln_distance < pair[1].ln_distance && jump < JUMP
        })
    }

    /// Whether a whisker at rest reaches the pole of this row.
    #[must_use]
    pub fn touches(&self, row: &Row) -> bool {
        self.tip[0].ln_distance > row.pole_distance.ln() - REACH_SLACK
    }
}

/// The tip edge from first touch to before the corner, with its extrema of distance among the samples.
fn tip_samples(method: Method, rod: &Rod, columns: &Columns) -> Vec<Sample> {
    let corner = &columns.folds[columns.tip];
    let launch = |load| Launch {
        rod: *rod,
        tau: corner.tau,
        load,
    };
    let launches: Vec<Launch> = (0..TIP_SAMPLES)
        .map(|i| launch(corner.load * i as f64 / TIP_SAMPLES as f64))
        .collect();
    let landings = land_in_company::<Nystrom8, First>(method, &launches);
    let mut samples: Vec<Sample> = Vec::new();
    let mut push = |launch: &Launch, landing: &Landing| {
        let near = samples.last().map_or(0.0, |sample| sample.phi);
        samples.push(Sample::new(launch.tau, launch.load, landing, near));
    };
    for i in 0..TIP_SAMPLES {
        push(&launches[i], &landings[i]);
        let Some(next) = landings.get(i + 1) else {
            break;
        };
        // A slope of exactly 0, as a straight whisker's at first touch, is a sample already.
        if landings[i].by_load.x * next.by_load.x < 0.0 {
            let start = stencil::<NODES>(i, landings.len());
            let slopes = landings[start..].iter().take(NODES).map(|l| l.by_load.x);
            let offset = (i - start) as f64;
            let between = [offset, offset + 1.0];
            let place = Polynomial::through(slopes).solve(0.0, offset + 0.5, between);
            let near = corner.load * (start as f64 + place) / TIP_SAMPLES as f64;
            let launch = launch(extremum(method, launches[i], launches[i + 1].load, near));
            let landing = land::<Nystrom8, First>(method, &[launch])[0];
            push(&launch, &landing);
        }
    }
    samples
}

/// The load between `from` and `to` at which `dlnD/dload` vanishes at the contact of `from`: Newton's method from `near`,
/// bisecting where a step would leave the bracket.
fn extremum(method: Method, from: Launch, to: f64, near: f64) -> f64 {
    let at = |load: f64| land::<Nystrom8, Second>(method, &[Launch { load, ..from }])[0];
    let (mut low, mut high) = (from.load, to);
    let mut load = near;
    let mut falling_at_low = None;
    for _ in 0..60 {
        let here = at(load);
        let slope = here.landing.by_load.x;
        let newton = load - slope / here.by_load_load.x;
        let inside = (newton - low) * (newton - high) < 0.0;
        if inside && (newton - load).abs() <= LAST_STEP * (to - from.load).abs() {
            return newton;
        }
        let falls = *falling_at_low.get_or_insert_with(|| at(from.load).landing.by_load.x < 0.0);
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
