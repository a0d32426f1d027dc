//! What a scene holds, as plain data.

use super::deviations::Deviations;
use super::grid::{FARTHEST, Grid, Morphology, NEAREST};
use super::whisker::{Curvature, Pole, Whisker};

/// What a [`Scene`](super::Scene) holds. It says nothing of whether the values are right; only a scene does.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// One line for people.
    pub title: String,
    /// The whisker as the file describes it, and the first one of a taper axis; [`Setup::whiskers`] yields those to
    /// simulate.
    pub whisker: Whisker,
    /// The pole.
    pub pole: Pole,
    /// The sweep.
    pub grid: Grid,
    /// How uncertain its numbers are, where the file says so.
    pub uncertainty: Option<Deviations>,
    /// Stem of the output files.
    pub name: String,
    /// The file as it was read.
    pub text: String,
}

impl Setup {
    /// The scene's whisker with a taper (`1 - tip/base radius`) and a parabola coefficient in place of its
    /// own. The vertex stays: the whisker's own, or 0 where its file gives no curvature.
    #[must_use]
    pub fn whisker_at(&self, taper: Option<f64>, curvature_per_mm: Option<f64>) -> Whisker {
        let mut whisker = self.whisker.clone();
        if let Some(taper) = taper {
            whisker.tip_radius_um = whisker.base_radius_um * (1.0 - taper);
        }
        if let Some(parabola_per_mm) = curvature_per_mm {
            let vertex_mm = whisker.curvature.map_or(0.0, |own| own.vertex_mm);
            whisker.curvature = Some(Curvature {
                parabola_per_mm,
                vertex_mm,
            });
        }
        whisker.curvature = whisker.curvature.filter(|c| c.parabola_per_mm != 0.0);
        whisker
    }

    /// Every whisker of the sweep, in the order of the atlas: taper varies fastest (its columns), curvature
    /// slowest (its rows). Without such axes, the one whisker of the file.
    pub fn whiskers(&self) -> impl Iterator<Item = (Morphology, Whisker)> {
        let tapers = choices(self.grid.taper.as_deref());
        let curvatures = choices(self.grid.curvature_per_mm.as_deref()).into_iter();
        curvatures.flat_map(move |curvature| {
            tapers.clone().into_iter().map(move |taper| {
                let whisker = self.whisker_at(taper, curvature);
                let own = whisker.curvature.map_or(0.0, |own| own.parabola_per_mm);
                let morphology = Morphology {
                    taper: taper.unwrap_or(whisker.taper()),
                    curvature_per_mm: curvature.unwrap_or(own),
                };
                (morphology, whisker)
            })
        })
    }

    /// The same, `size` whiskers at a time; the last group has what is left.
    pub fn whisker_groups(&self, size: usize) -> impl Iterator<Item = Vec<(Morphology, Whisker)>> {
        let mut whiskers = self.whiskers();
        let next = move || -> Vec<_> { whiskers.by_ref().take(size).collect() };
        std::iter::repeat_with(next).take_while(|group| !group.is_empty())
    }

    /// How many whiskers the sweep has.
    #[must_use]
    pub fn whisker_count(&self) -> usize {
        let values = |axis: &Option<Vec<f64>>| axis.as_ref().map_or(1, Vec::len);
        values(&self.grid.taper) * values(&self.grid.curvature_per_mm)
    }

    /// The first whisker of the sweep, or the only one.
    #[must_use]
    pub fn first_whisker(&self) -> Whisker {
        let first = |axis: &Option<Vec<f64>>| axis.as_ref().and_then(|axis| axis.first().copied());
        self.whisker_at(first(&self.grid.taper), first(&self.grid.curvature_per_mm))
    }

    /// The last one. Axes grow from 0 at least, so it tapers and is curved if any whisker is.
    #[must_use]
    pub fn last_whisker(&self) -> Whisker {
        let last = |axis: &Option<Vec<f64>>| axis.as_ref().and_then(|axis| axis.last().copied());
        self.whisker_at(last(&self.grid.taper), last(&self.grid.curvature_per_mm))
    }

    /// Whether whiskers are swept: whether there is an axis of taper or curvature.
    #[must_use]
    pub fn is_sweep(&self) -> bool {
        self.grid.taper.is_some() || self.grid.curvature_per_mm.is_some()
    }

    /// The smallest and the largest distance of first touch; it must be more than the pole's radius, too.
    #[must_use]
    pub fn distances_mm(&self) -> (f64, f64) {
        let length = self.whisker.length_mm;
        (length / NEAREST, FARTHEST * length)
    }
}

/// What an axis puts in place of the whisker's own value: its values one by one, or nothing, once.
fn choices(axis: Option<&[f64]>) -> Vec<Option<f64>> {
    axis.map_or(vec![None], |axis| axis.iter().copied().map(Some).collect())
}
