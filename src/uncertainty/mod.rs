//! Uncertainty of detachments from the uncertainty of a scene's numbers: by random whiskers, and to first order.
//!
//! Numbers vary independently and normally, with the standard deviations of `[uncertainty]`. A draw that the scene
//! refuses is repeated. Equal seeds give equal draws, whatever the number of threads.

mod first_order;
mod spread;
mod varying;

pub use spread::{EndSpread, LargestSpread, PointSpread};

use crate::random::RandomStream;
use crate::scene::{Deviations, Pole, Scene, Whisker};
use crate::trace::{
    Detachment, DetachmentKind, EndDetail, PushLoad, PushedWhisker, StableBranch, detachments,
    sides_at_once,
};
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;
use varying::{Varying, moved, varying};
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// Most ends on one side; an end takes 40 bytes.
const MOST_ENDS: usize = 1 << 24;

/// Most draws for one sample.
const MOST_TRIES: u64 = 1000;

/// Random whiskers drawn from the uncertainty of a scene.
#[derive(Clone, Debug)]
pub struct Draws {
    scene: Scene,
    varying: Vec<Varying>,
    drawn: Vec<(Whisker, Pole)>,
    /// Number of draws that the scene has refused.
    pub refused: u64,
}

/// Error of drawing whiskers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// The scene has no table `[uncertainty]`.
    #[error(
        "the scene has no [uncertainty]: add that table, such as `base_radius_um = 1.0`, a standard deviation"
    )]
    NoTable,
    /// The table `[uncertainty]` has standard deviations of frames alone.
    #[error(
        "the scene's [uncertainty] is of frames alone: add a parameter of the scene, such as `base_radius_um = 1.0`, a standard deviation"
    )]
    FramesAlone,
    /// The scene sweeps whiskers along the axis of this key, but draws need one whisker.
    #[error("{0}: must be left out, as one whisker is drawn around")]
    Sweep(&'static str),
    /// The number of samples times the number of distances exceeds the limit.
    #[error(
        "makes {ends} ends at the scene's {distances} distances on each side; must make at most {MOST_ENDS}"
    )]
    TooMany {
        /// Number of samples times the number of distances.
        ends: usize,
        /// Number of distances of the scene.
        distances: usize,
    },
    /// The standard deviations are far larger than the ranges of the scene, which refuses almost every draw.
    #[error(
        "{MOST_TRIES} draws in a row are outside of the scene's limits; [uncertainty] must have smaller deviations; the \
         last one: {why}"
    )]
    Refused {
        /// Reason why the scene refuses the last draw.
        why: String,
    },
}

impl Draws {
    /// Draws `samples` random whiskers; equal seeds give equal whiskers.
    ///
    /// # Errors
    /// If the scene has no `[uncertainty]` of its parameters, sweeps whiskers, or refuses almost every draw, or if there are too many.
    pub fn new(scene: &Scene, samples: usize, seed: u64) -> Result<Self, DrawError> {
        let deviations: &Deviations = scene.uncertainty.as_ref().ok_or(DrawError::NoTable)?;
        if deviations.parameters.is_empty() && deviations.profile_radius_um.is_none() {
            return Err(DrawError::FramesAlone);
        }
        if let Some(axis) = scene.grid.sweep.first() {
            return Err(DrawError::Sweep(axis.variable.key()));
        }
        let distances = scene.grid.distance_mm.len();
        let ends = samples.saturating_mul(distances);
        if ends > MOST_ENDS {
            return Err(DrawError::TooMany { ends, distances });
        }
        let varying = varying(scene, deviations);
        let draws = (0..samples as u64)
            .into_par_iter()
            .map(|sample| draw(scene, &varying, RandomStream::new(seed, sample)));
        let (drawn, refused): (Vec<_>, Vec<u64>) = draws.collect::<Result<_, _>>()?;
        Ok(Self { scene: scene.clone(), varying, drawn, refused: refused.into_iter().sum() })
    }

    /// Returns the number of whiskers that were drawn at random.
    #[must_use]
    pub fn len(&self) -> usize {
        self.drawn.len()
    }

    /// Returns true if there are no random whiskers.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.drawn.is_empty()
    }

    /// Computes the spread of the ends of pushes on one side, `[distance]`, at every distance of the scene. `tick` is called once for
    /// every whisker, after its batch.
    #[must_use]
    pub fn spread(
        &self,
        resolution: Resolution,
        side: Side,
        tick: &(dyn Fn() + Sync),
    ) -> Vec<EndSpread> {
        let distances = &self.scene.grid.distance_mm;
        let curves = |whiskers: &[(Whisker, Pole)]| {
            let pushed = whiskers.iter().map(|(whisker, pole)| PushedWhisker {
                whisker,
                pole,
                side,
                distances_mm: distances,
            });
            let keep = |_, end, _| PushEnd::new(&end);
            let pushed: Vec<PushedWhisker> = pushed.collect();
            let never = AtomicBool::new(false);
            let ends = detachments(resolution, &pushed, EndDetail::State, &never, keep);
            ends.unwrap_or_default()
        };
        let of_drawn = |drawn: &[(Whisker, Pole)]| {
            let ends = curves(drawn);
            drawn.iter().for_each(|_| tick());
            ends
        };
        let at_once = sides_at_once(self.drawn.len(), distances.len());
        let drawn = self.drawn.par_chunks(at_once).flat_map_iter(of_drawn);
        let ends: Vec<Vec<PushEnd>> = drawn.collect();
        let scene_ends = curves(&[(self.scene.whisker.clone(), self.scene.pole)]).concat();
        let first_order = first_order::deviations_deg(&self.scene, &self.varying, resolution, side);
        let rows = distances.iter().zip(scene_ends).zip(first_order).enumerate();
        rows.map(|(row, ((distance_mm, scene_end), first_order_deg))| {
            let ends = ends.iter().map(|ends| ends[row]);
            EndSpread::new(side, *distance_mm, scene_end, ends, first_order_deg)
        })
        .collect()
    }

    /// Computes the spread of the largest loads of pushes on one side, `[distance]`, at every distance of the scene. Each push takes some
    /// milliseconds. `tick` is called after every whisker.
    #[must_use]
    pub fn largest(&self, side: Side, tick: &(dyn Fn() + Sync)) -> Vec<LargestSpread> {
        let distances = &self.scene.grid.distance_mm;
        let loads = |whisker: &Whisker, pole: &Pole| {
            let distances = distances.iter();
            let loads = distances.map(|distance| largest_loads((whisker, pole), side, *distance));
            loads.collect::<Vec<_>>()
        };
        let drawn = self.drawn.par_iter().map(|(whisker, pole)| {
            let loads = loads(whisker, pole);
            tick();
            loads
        });
        let drawn: Vec<Vec<Option<[f64; 3]>>> = drawn.collect();
        let scene_loads = loads(&self.scene.whisker, &self.scene.pole).into_iter();
        let spread = |(row, row_loads): (usize, Option<[f64; 3]>)| {
            LargestSpread::new(row_loads, drawn.iter().filter_map(|loads| loads[row]))
        };
        scene_loads.enumerate().map(spread).collect()
    }
}

/// Returns the largest contact force (uN), moment at the base (nN m) and strain of a push; `None` if it has no known states.
fn largest_loads(
    (whisker, pole): (&Whisker, &Pole),
    side: Side,
    distance_mm: f64,
) -> Option<[f64; 3]> {
    let branch = StableBranch::new(whisker, pole, side, distance_mm).ok()?;
    let loads = PushLoad::ALL.map(|load| branch.peak(load).size);
    loads.iter().all(|load| load.is_finite()).then_some(loads)
}

/// End of a push.
#[derive(Clone, Copy, Debug)]
struct PushEnd {
    kind: DetachmentKind,
    /// Push angle in degrees, force in uN and moment at the base in nN m; `None` without a detachment.
    loads: Option<[f64; 3]>,
}

impl PushEnd {
    fn new(end: &Detachment) -> Self {
        let loads = || Some([end.push_angle_deg?, end.force_un?, end.base_moment_nnm?]);
        Self { kind: end.kind, loads: loads() }
    }
}

/// A drawn whisker with its pole, and the number of draws refused before it.
type Drawn = ((Whisker, Pole), u64);

/// The first whisker of a random stream that the scene accepts.
fn draw(scene: &Scene, varying: &[Varying], mut random: RandomStream) -> Result<Drawn, DrawError> {
    let mut refused = 0;
    loop {
        let step = |one: &Varying| (*one, one.deviation * random.normal());
        let steps: Vec<_> = varying.iter().map(step).collect();
        match moved(scene, &steps) {
            Ok(drawn) => return Ok(((drawn.whisker.clone(), drawn.pole), refused)),
            Err(why) if refused + 1 == MOST_TRIES => {
                let why = why.to_string();
                let first = why.lines().next().unwrap_or_default();
                let why = first.trim_start_matches("error: ").to_owned();
                return Err(DrawError::Refused { why });
            }
            Err(_) => refused += 1,
        }
    }
}
