//! Marks of states and pushes whose largest bending strain exceeds the yield strain of the whisker.
//!
//! Beyond its yield strain a whisker is not elastic, so that a real whisker is in another state. The marks change no state.

use crate::design::DesignVaried;
use crate::scene::{Pole, Scene, Whisker};
use crate::trace::{ContactColumns, Corner, Detachment, PushLoad, StableBranch, StateRow, row};
use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;
use whiskmap_mechanics::rod::{Rod, Side};
use whiskmap_mechanics::shooting::PeakStrain;
use whiskmap_mechanics::shooting::batch::{Batch, InitialCondition, Method};

row! {
    /// Mark of a row that has its largest strain in another column.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct YieldMark {
        /// True if the largest bending strain exceeds the yield strain.
        pub yields: Option<bool>,
    }
}

row! {
    /// Mark of a state, with its largest strain.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct StrainMark {
        /// Largest bending strain of the state at the surface, dimensionless.
        pub peak_strain: Option<f64>,
        /// True if the largest bending strain of the state exceeds the yield strain.
        pub yields: Option<bool>,
    }
}

row! {
    /// Mark of a push, with its largest strain.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct PushMark {
        /// Largest bending strain from first touch to the detachment, dimensionless.
        pub max_strain: Option<f64>,
        /// True if the largest bending strain of the push exceeds the yield strain.
        pub yields: Option<bool>,
    }
}

impl YieldMark {
    /// Returns the mark of a row of `whisker` with this largest bending `strain`, `None` without a state. Returns `None` without a yield strain.
    #[must_use]
    pub fn new(whisker: &Whisker, strain: impl Into<Option<f64>>) -> Option<Self> {
        whisker.yield_strain?;
        let yields = strain.into().and_then(|strain| whisker.yields(strain));
        Some(Self { yields })
    }

    /// Returns the marks of rows of `whisker` with these largest bending strains, `[row]`; `None` without a yield strain.
    #[must_use]
    pub fn of_rows(whisker: &Whisker, strains: impl IntoIterator<Item = f64>) -> Option<Vec<Self>> {
        whisker.yield_strain?;
        let strains = strains.into_iter();
        strains.map(|strain| Self::new(whisker, strain)).collect()
    }
}

/// Returns the rod of the state with this `contact`, with its force ratio as friction, and contact and load `(tau, load)`; `None` without a
/// pole that bends the whisker. A table without the angle of the contact has no friction.
fn condition(whisker: &Whisker, pole: &Pole, contact: &ContactColumns) -> Option<(Rod, DVec2)> {
    let (side, arc_length_mm) = contact.side.zip(contact.arc_length_mm)?;
    let [x, y] = contact.base_force_un;
    let force_un = DVec2::new(x?, y?);
    let rod = whisker.rod(pole, side);
    let units = whisker.units();
    let tangent = DVec2::from_angle(contact.contact_angle_deg.unwrap_or_default().to_radians());
    let [along, normal] = [tangent, tangent.perp()].map(|axis| axis.dot(force_un));
    let friction = match rod.friction == 0.0 || normal == 0.0 {
        true => 0.0,
        false => along / normal,
    };
    let tau = rod.tau(arc_length_mm / units.length_mm);
    let force = side.sign() * force_un.length() / units.force_un;
    let load = force / rod.radius(tau).powi(2);
    Some((Rod { friction, ..rod }, DVec2::new(tau, load)))
}

impl StrainMark {
    /// Computes the largest strains of `rows`, and marks them: `[row]`, empty cells without a state. A row without a side and with a force of 0
    /// has a free whisker. `None` without a yield strain.
    #[must_use]
    pub fn of_rows(whisker: &Whisker, pole: &Pole, rows: &[impl StateRow]) -> Option<Vec<Self>> {
        whisker.yield_strain?;
        let contacts: Vec<ContactColumns> = rows.iter().map(StateRow::contact).collect();
        let loaded = contacts.iter().map(|contact| condition(whisker, pole, contact));
        let loaded: Vec<Option<(Rod, DVec2)>> = loaded.collect();
        let conditions =
            loaded.iter().flatten().map(|(rod, point)| InitialCondition::new(rod, *point));
        let conditions: Vec<InitialCondition> = conditions.collect();
        let peaks: Vec<PeakStrain> = Batch::new(Method::fine().doubled()).shoot(&conditions);
        let mut peaks = peaks.into_iter();
        let unit = whisker.units().strain;
        let marks = contacts.iter().zip(&loaded).map(|(contact, loaded)| {
            let is_free = (contact.side, contact.force_un) == (None, Some(0.0));
            let peak_strain = match loaded {
                Some(_) => peaks.next().map(|peak| peak.strain * unit),
                None => is_free.then_some(0.0),
            };
            Self { peak_strain, yields: peak_strain.and_then(|strain| whisker.yields(strain)) }
        });
        Some(marks.collect())
    }
}

impl PushMark {
    /// Marks the pushes of `whisker` at `pole` that have these `ends`, `[end]`.
    #[must_use]
    pub fn of_ends<'a>(
        whisker: &Whisker,
        pole: &Pole,
        ends: impl Iterator<Item = &'a Detachment>,
    ) -> Vec<Option<Self>> {
        let ends: Vec<&Detachment> = ends.collect();
        let marks = ends.into_par_iter().map(|end| Self::of_end(whisker, pole, end));
        marks.collect()
    }

    /// Marks a push of `whisker` at `pole` that has this `end`: empty cells without a detachment. `None` without a yield strain.
    #[must_use]
    pub fn of_end(whisker: &Whisker, pole: &Pole, end: &Detachment) -> Option<Self> {
        let distance_mm = end.push_angle_deg.and(Some(end.distance_mm));
        Self::new(whisker, pole, end.side, distance_mm)
    }

    /// Marks the push of `whisker` at `pole` that ends at a `corner`: empty cells without one. `None` without a yield strain.
    #[must_use]
    pub fn of_corner(whisker: &Whisker, pole: &Pole, corner: &Corner) -> Option<Self> {
        Self::new(whisker, pole, corner.side, corner.distance_mm)
    }

    /// Marks the push of a design's solution: the scene with these `values` of the `varied` numbers, `[variable]`, with the pole on a side at a
    /// distance in mm unless that varies. `None` without a yield strain.
    #[must_use]
    pub fn of_solution(
        scene: &Scene,
        varied: &DesignVaried,
        (side, distance_mm): (Side, f64),
        values: &[f64],
    ) -> Option<Self> {
        scene.whisker.yield_strain?;
        let solution = varied.scene_at(scene, distance_mm, values);
        let mark = solution.ok().and_then(|solution| {
            let distance_mm = solution.grid.distance_mm[0];
            Self::new(&solution.whisker, &solution.pole, side, distance_mm)
        });
        Some(mark.unwrap_or_default())
    }

    /// Marks a push of `whisker` at `pole`, whose first touch is at `distance_mm` from the base, until it detaches: empty cells without a distance or
    /// states. `None` without a yield strain.
    ///
    /// The stable states up to the end are followed, which takes one or two milliseconds.
    #[must_use]
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        side: Side,
        distance_mm: impl Into<Option<f64>>,
    ) -> Option<Self> {
        whisker.yield_strain?;
        let distance_mm = distance_mm.into();
        let branch = distance_mm
            .and_then(|distance_mm| StableBranch::new(whisker, pole, side, distance_mm).ok());
        let strain = branch.map(|branch| branch.peak(PushLoad::Strain).size);
        let max_strain = strain.filter(|strain| strain.is_finite());
        Some(Self { max_strain, yields: max_strain.and_then(|strain| whisker.yields(strain)) })
    }
}
