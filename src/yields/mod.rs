//! Marks of states and pushes whose largest bending strain exceeds the yield strain of the whisker.
//!
//! Beyond its yield strain a whisker is not elastic, so that the state is not that of a real whisker. The marks change no state.

use crate::design::DesignVaried;
use crate::locate::LocatedState;
use crate::scene::{Pole, Scene, Whisker};
use crate::sensitivity::VariableEffect;
use crate::texture::TextureSample;
use crate::trace::{BranchPoint, Detachment, PushLoad, ShapePoint, StableBranch, row};
use crate::uncertainty::LargestSpread;
use crate::whisk::WhiskSample;
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

/// Row of a table that has the largest strain of a state or of a push.
pub trait StrainRow {
    /// Returns the largest bending strain of the row; `None` without a state.
    fn strain(&self) -> Option<f64>;
}

impl StrainRow for BranchPoint {
    fn strain(&self) -> Option<f64> {
        Some(self.peak_strain)
    }
}

impl StrainRow for ShapePoint {
    fn strain(&self) -> Option<f64> {
        Some(self.strain)
    }
}

impl StrainRow for VariableEffect {
    fn strain(&self) -> Option<f64> {
        self.max_strain
    }
}

impl StrainRow for LargestSpread {
    fn strain(&self) -> Option<f64> {
        self.max_strain
    }
}

impl YieldMark {
    /// Returns the mark of a row of `whisker`; `None` without a yield strain.
    #[must_use]
    pub fn new(whisker: &Whisker, row: &impl StrainRow) -> Option<Self> {
        whisker.yield_strain?;
        let yields = row.strain().and_then(|strain| whisker.yields(strain));
        Some(Self { yields })
    }

    /// Returns the marks of the rows of `whisker`, `[row]`; `None` without a yield strain.
    #[must_use]
    pub fn of_rows(whisker: &Whisker, rows: &[impl StrainRow]) -> Option<Vec<Self>> {
        rows.iter().map(|row| Self::new(whisker, row)).collect()
    }
}

/// Contact of a state with the force of the pole, as tables have them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLoad {
    /// Side of the whisker that the pole is on.
    pub side: Side,
    /// Arclength from the base to the contact, in mm.
    pub arc_length_mm: f64,
    /// Force that the pole puts on the base, along its tangent and to the left of it, in uN.
    pub base_force_un: DVec2,
    /// Angle of the tangent at the contact, from the base's tangent, in degrees. It does not count without friction.
    pub contact_angle_deg: f64,
}

/// Contact of a row's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowContact {
    /// The row has no state.
    Unknown,
    /// The whisker is at rest.
    Free,
    /// The pole bends the whisker.
    Loaded(ContactLoad),
}

/// Row of a table that has the contact of a state with its load.
pub trait ContactRow {
    /// Returns the contact of the row's state.
    fn contact(&self) -> RowContact;
}

impl ContactRow for WhiskSample {
    fn contact(&self) -> RowContact {
        RowContact::of(
            (self.side, self.force_un),
            self.arc_length_mm,
            [self.base_force_x_un, self.base_force_y_un],
            self.contact_angle_deg,
        )
    }
}

impl ContactRow for TextureSample {
    fn contact(&self) -> RowContact {
        // Asperities have no friction, so that the angle does not count.
        RowContact::of(
            (self.side, self.force_un),
            self.arc_length_mm,
            [self.base_force_x_un, self.base_force_y_un],
            Some(0.0),
        )
    }
}

impl ContactRow for LocatedState {
    fn contact(&self) -> RowContact {
        RowContact::of(
            (self.side, self.force_un),
            self.arc_length_mm,
            [self.base_force_x_un, self.base_force_y_un],
            self.contact_angle_deg,
        )
    }
}

impl RowContact {
    /// Creates the contact of a row with these columns. A row without a side and with a force of 0 has a free whisker.
    fn of(
        (side, force_un): (Option<Side>, Option<f64>),
        arc_length_mm: Option<f64>,
        [x, y]: [Option<f64>; 2],
        contact_angle_deg: Option<f64>,
    ) -> Self {
        if (side, force_un) == (None, Some(0.0)) {
            return Self::Free;
        }
        let load = || {
            Some(ContactLoad {
                side: side?,
                arc_length_mm: arc_length_mm?,
                base_force_un: DVec2::new(x?, y?),
                contact_angle_deg: contact_angle_deg?,
            })
        };
        load().map_or(Self::Unknown, Self::Loaded)
    }
}

impl ContactLoad {
    /// Returns the rod of the state, with its force ratio as friction, and contact and load `(tau, load)`.
    fn condition(&self, whisker: &Whisker, pole: &Pole) -> (Rod, DVec2) {
        let rod = whisker.rod(pole, self.side);
        let units = whisker.units();
        let tangent = DVec2::from_angle(self.contact_angle_deg.to_radians());
        let [along, normal] = [tangent, tangent.perp()].map(|axis| axis.dot(self.base_force_un));
        let friction = match rod.friction == 0.0 || normal == 0.0 {
            true => 0.0,
            false => along / normal,
        };
        let tau = rod.tau(self.arc_length_mm / units.length_mm);
        let force = self.side.sign() * self.base_force_un.length() / units.force_un;
        let load = force / rod.radius(tau).powi(2);
        (Rod { friction, ..rod }, DVec2::new(tau, load))
    }
}

impl StrainMark {
    /// Computes the largest strains of `rows`, and marks them: `[row]`, empty cells without a state. `None` without a yield strain.
    #[must_use]
    pub fn of_rows(whisker: &Whisker, pole: &Pole, rows: &[impl ContactRow]) -> Option<Vec<Self>> {
        whisker.yield_strain?;
        let contacts = rows.iter().map(ContactRow::contact);
        let contacts: Vec<RowContact> = contacts.collect();
        let loaded = contacts.iter().filter_map(|contact| match contact {
            RowContact::Loaded(load) => Some(load.condition(whisker, pole)),
            RowContact::Free | RowContact::Unknown => None,
        });
        let loaded: Vec<(Rod, DVec2)> = loaded.collect();
        let conditions = loaded.iter().map(|(rod, point)| InitialCondition {
            rod,
            tau: point.x,
            load: point.y,
        });
        let conditions: Vec<InitialCondition> = conditions.collect();
        let peaks: Vec<PeakStrain> = Batch::new(Method::fine().doubled()).shoot(&conditions);
        let mut peaks = peaks.into_iter();
        let unit = whisker.units().strain;
        let marks = contacts.iter().map(|contact| {
            let strain = match contact {
                RowContact::Unknown => None,
                RowContact::Free => Some(0.0),
                RowContact::Loaded(_) => peaks.next().map(|peak| peak.strain * unit),
            };
            Self {
                peak_strain: strain,
                yields: strain.and_then(|strain| whisker.yields(strain)),
            }
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
        let marks = ends
            .into_par_iter()
            .map(|end| Self::of_end(whisker, pole, end));
        marks.collect()
    }

    /// Marks a push of `whisker` at `pole` that has this `end`: empty cells without a detachment. `None` without a yield strain.
    #[must_use]
    pub fn of_end(whisker: &Whisker, pole: &Pole, end: &Detachment) -> Option<Self> {
        match end.push_angle_deg {
            Some(_) => Self::new(whisker, pole, end.side, end.distance_mm),
            None => whisker.yield_strain.map(|_| Self::default()),
        }
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
        let mark = solution.ok().and_then(|own| {
            let distance_mm = own.grid.distance_mm[0];
            Self::new(&own.whisker, &own.pole, side, distance_mm)
        });
        Some(mark.unwrap_or_default())
    }

    /// Marks a push of `whisker` at `pole`, whose first touch is at `distance_mm` from the base, until it detaches: empty cells without states.
    /// `None` without a yield strain.
    ///
    /// The stable states up to the end are followed, which takes one or two milliseconds.
    #[must_use]
    pub fn new(whisker: &Whisker, pole: &Pole, side: Side, distance_mm: f64) -> Option<Self> {
        whisker.yield_strain?;
        let branch = StableBranch::new(whisker, pole, side, distance_mm).ok();
        let strain = branch.map(|branch| branch.peak(PushLoad::Strain).size);
        let max_strain = strain.filter(|strain| strain.is_finite());
        Some(Self {
            max_strain,
            yields: max_strain.and_then(|strain| whisker.yields(strain)),
        })
    }
}
