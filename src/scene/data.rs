//! Data of a scene, and the whiskers of its sweep.

use super::builder::Deviations;
use super::grid::{FARTHEST, Grid, NEAREST, SweepPlace};
use super::parameter::Parameter;
use super::surface::Surface;
use super::table::TableWhisker;
use super::toml::SceneText;
use super::whisker::{Curvature, Pole, Whisker};
use std::sync::Arc;
use whiskmap_mechanics::rod::{Rod, Side};

/// Data of a scene. Only a [`Scene`](super::Scene) guarantees that the values are valid.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneData {
    /// Title of the scene: one line of text.
    pub title: String,
    /// Whisker of the scene, the first one of a sweep that exists. [`SceneData::whiskers`] yields the whiskers to simulate.
    pub whisker: Whisker,
    /// Pole of the scene, the first one of a sweep that exists.
    pub pole: Pole,
    /// Push angles, distances and sweep axes of the map.
    pub grid: Grid,
    /// Whiskers of the table of whiskers, `[row]`; empty without one.
    pub table: Arc<[TableWhisker]>,
    /// Standard deviations of the scene's numbers; `None` if the scene does not give them.
    pub uncertainty: Option<Deviations>,
    /// Rough surface in front of the whisker; `None` if the scene does not give it.
    pub surface: Option<Surface>,
    /// Name of the scene: the stem of its output files.
    pub name: String,
    /// TOML text of the scene.
    pub text: SceneText,
}

/// One whisker of a sweep, in front of its pole.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptWhisker {
    /// Place of the whisker in the sweep.
    pub place: SweepPlace,
    /// Whisker at this place of the sweep.
    pub whisker: Whisker,
    /// Pole in front of the whisker.
    pub pole: Pole,
}

impl SweptWhisker {
    /// Returns the dimensionless rod of the swept whisker with its pole on `side`: lengths are in whisker lengths.
    #[must_use]
    pub fn rod(&self, side: Side) -> Rod {
        self.whisker.rod(&self.pole, side)
    }
}

/// Row of a table of whiskers without a whisker, at a place of the sweep.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name}: {reason}")]
pub struct RefusedWhisker {
    /// Place of the row in the sweep.
    pub place: SweepPlace,
    /// Name of the row.
    pub name: String,
    /// Reason why the row has no whisker.
    pub reason: String,
}

impl SceneData {
    /// Returns the whisker and pole of `place`. They come from its row in the table of whiskers, or from the scene, and have the values of
    /// `place`. A taper determines the radius at the tip. The vertex of a curvature axis is the whisker's own, or 0 if the scene gives
    /// none.
    ///
    /// # Errors
    /// If the row of the table has no whisker.
    pub fn whisker_at(&self, place: SweepPlace) -> Result<SweptWhisker, RefusedWhisker> {
        let row = place.row().and_then(|row| self.table.get(row));
        let (mut whisker, mut pole) = match row {
            None => (self.whisker.clone(), self.pole),
            Some(TableWhisker { found: Ok(whisker_and_pole), .. }) => whisker_and_pole.clone(),
            Some(TableWhisker { name, found: Err(reason) }) => {
                return Err(RefusedWhisker { place, name: name.clone(), reason: reason.clone() });
            }
        };
        let mut curvature = whisker.curvature.unwrap_or_default();
        for (parameter, value) in place.values() {
            match parameter {
                Parameter::LengthMm => whisker.length_mm = value,
                Parameter::BaseRadiusUm => whisker.base_radius_um = value,
                Parameter::TipRadiusUm => whisker.tip_radius_um = value,
                Parameter::ParabolaPerMm => curvature.parabola_per_mm = value,
                Parameter::VertexMm => curvature.vertex_mm = value,
                Parameter::ModulusTipToBase => whisker.modulus_tip_to_base = value,
                Parameter::ArcStretch => whisker.arc_stretch = value,
                Parameter::FollicleStiffness => {
                    whisker.follicle_stiffness_nnm_per_rad = Some(value);
                }
                Parameter::PoleRadiusMm => pole.radius_mm = value,
                Parameter::Friction => pole.friction = value,
                // It needs both radii.
                Parameter::Taper => {}
                // They are no axes of a sweep.
                Parameter::YoungsModulusGpa
                | Parameter::ProfileScale
                | Parameter::TipExtensionMm
                | Parameter::SpiralPerMm
                | Parameter::SpiralPerMm2 => {}
            }
        }
        if let Some(taper) = place.value(Parameter::Taper) {
            whisker.tip_radius_um = whisker.base_radius_um * (1.0 - taper);
        }
        whisker.curvature = Some(curvature).filter(Curvature::is_given);
        Ok(SweptWhisker { place, whisker, pole })
    }

    /// Returns every whisker of the sweep; the first axis varies fastest. Without axes, it is the one whisker of the scene. Places of rows
    /// without a whisker have the reason.
    pub fn whiskers(&self) -> impl Iterator<Item = Result<SweptWhisker, RefusedWhisker>> {
        (0..self.whisker_count()).map(|index| self.whisker(index))
    }

    /// Returns whisker `index` of the sweep, in the order of [`Self::whiskers`]. Indices are taken modulo [`Self::whisker_count`].
    ///
    /// # Errors
    /// If its row in the table of whiskers has no whisker.
    pub fn whisker(&self, index: usize) -> Result<SweptWhisker, RefusedWhisker> {
        self.whisker_at(self.grid.place(index))
    }

    /// Returns the whiskers of the sweep in groups of `size`, `[group][whisker]`; the last group has the rest.
    pub fn whisker_groups(
        &self,
        size: usize,
    ) -> impl Iterator<Item = Vec<Result<SweptWhisker, RefusedWhisker>>> {
        let mut whiskers = self.whiskers();
        let next = move || -> Vec<_> { whiskers.by_ref().take(size).collect() };
        std::iter::repeat_with(next).take_while(|group| !group.is_empty())
    }

    /// Returns the number of whiskers of the sweep.
    #[must_use]
    pub fn whisker_count(&self) -> usize {
        self.grid.whisker_count()
    }

    /// Returns the first whisker of the sweep that exists, or the only one.
    #[must_use]
    pub fn first_whisker(&self) -> SweptWhisker {
        let mut whiskers = self.whiskers().flatten();
        // One of the whiskers of a scene exists.
        whiskers.next().unwrap_or_else(|| SweptWhisker {
            place: self.grid.place(0),
            whisker: self.whisker.clone(),
            pole: self.pole,
        })
    }

    /// Returns the rows of the table of whiskers that have no whisker, each with the reason.
    pub fn refused(&self) -> impl Iterator<Item = (&str, &str)> {
        let rows = self.table.iter();
        rows.filter_map(|row| Some((&*row.name, &**row.found.as_ref().err()?)))
    }

    /// Returns the whiskers at the ends of the sweep axes, and all of a table. If any whisker has an effect, one of these has it.
    pub fn corner_whiskers(&self) -> impl Iterator<Item = SweptWhisker> {
        let ends = self.grid.ends();
        let corners = 0..ends.whisker_count();
        corners.filter_map(move |index| self.whisker_at(ends.place(index)).ok())
    }

    /// Returns true if any whisker of the sweep has friction with its pole.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.corner_whiskers().any(|swept| swept.pole.friction != 0.0)
    }

    /// Returns true if the scene, or any row of its table of whiskers, has a yield strain.
    #[must_use]
    pub fn has_yield_strain(&self) -> bool {
        let rows = self.table.iter().filter_map(|row| row.found.as_ref().ok());
        let mut whiskers = rows.map(|(whisker, _)| whisker).chain([&self.whisker]);
        whiskers.any(|whisker| whisker.yield_strain.is_some())
    }

    /// Returns true if all whiskers of the sweep are straight at rest.
    #[must_use]
    pub fn is_straight(&self) -> bool {
        self.corner_whiskers().all(|swept| swept.whisker.sharpest_bend_per_mm() == 0.0)
    }

    /// Returns true if the scene has an axis along which whiskers differ.
    #[must_use]
    pub fn is_sweep(&self) -> bool {
        !self.grid.sweep.is_empty()
    }

    /// Returns the smallest and the largest allowed distance of first touch, in millimetres. It must exceed the pole's radius, too.
    #[must_use]
    pub fn distances_mm(&self) -> (f64, f64) {
        let length = self.whisker.length_mm;
        (length / NEAREST, FARTHEST * length)
    }
}
