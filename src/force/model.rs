//! Force of the full model: the stable state with the measured curvature, at the measured distance of the contact from the base.

use super::lever::Bending;
use super::state_curve::{Measured, ModelState, StateCurve};
use super::{CurvatureFrame, FrameContact, FrameForce, NoForce};
use crate::scene::{Pole, Whisker};
use crate::sheet::Sheet;
use glam::DVec2;
use whiskmap_mechanics::rod::{Rest, Rod, Side, Units};
use whiskmap_mechanics::shooting::Resolution;
use whiskmap_mechanics::shooting::batch::Method;

/// Number of intervals between the rows of a sheet.
const ROWS: u32 = 16;

/// Model of the whisker, with the pole on each side.
pub struct Model {
    sides: [(Rod, Sheet); 2],
    units: Units,
}

impl Model {
    /// Creates the model; contacts are at least `nearest_mm` from the base. Frames show the whisker from its base on, so that it does not
    /// matter how the follicle holds the base.
    pub fn new(whisker: &Whisker, pole: &Pole, nearest_mm: f64) -> Self {
        let method = Method::new(Resolution::FINE);
        // A sheet is certified at the contacts of its rows: those from the nearest to the tip.
        let nearest = (nearest_mm / whisker.length_mm).min(1.0);
        let distance = |i| nearest * libm::pow(1.0 / nearest, f64::from(i) / f64::from(ROWS));
        let distances: Vec<f64> = (0..=ROWS).map(distance).collect();
        let sides = [Side::Cb, Side::Cf].map(|side| {
            let rod = Rod {
                mount: 0.0,
                ..whisker.rod(&Pole::smooth(pole.radius_mm), side)
            };
            let sheet = Sheet::of_ends(method, &rod, side, &distances);
            (rod, sheet)
        });
        Self {
            sides,
            units: whisker.units(),
        }
    }

    /// Returns the force in a frame in contact.
    pub fn force(
        &self,
        bending: &Bending,
        frame: &CurvatureFrame,
        contact: &FrameContact,
    ) -> FrameForce {
        let none = |reason| bending.none(frame.time_s, reason);
        let length = self.units.length_mm;
        let measured = Measured {
            contact: DVec2::from(contact.contact_mm) / length,
            at: frame.at_arc_length_mm / length,
            change: bending.change_per_mm * length,
        };
        let [(rod, _), _] = &self.sides;
        let rest = Rest::new(&Rod {
            pole: 0.0,
            ..rod.clone()
        });
        let (s, _) = rest.touch_at_distance(measured.contact.length());
        if s > rest.end() {
            return none(NoForce::OutOfReach);
        }
        if s <= measured.at {
            return none(NoForce::NoLever);
        }
        let off = |state: &ModelState| state.contact.distance(measured.contact);
        let found = self.sides.iter().flat_map(|(rod, sheet)| {
            let curve = StateCurve {
                rod,
                sheet,
                measured,
            };
            curve.states(rod.tau(s))
        });
        let nearest = found.min_by(|one, other| off(one).total_cmp(&off(other)));
        let Some(state) = nearest else {
            return none(NoForce::NoState);
        };
        let ModelState { point, base, .. } = state;
        let units = &self.units;
        let force = point.y * rod.radius(point.x).powi(2);
        let on_base = force * DVec2::new(base.tangent.y, base.tangent.x) * units.force_un;
        FrameForce {
            force_un: Some((force * units.force_un).abs()),
            base_force_x_un: Some(on_base.x),
            base_force_y_un: Some(on_base.y),
            base_moment_nnm: Some(-force * base.position.x * units.moment_nnm),
            contact_angle_deg: Some(-base.tangent.to_angle().to_degrees()),
            contact_off_mm: Some(off(&state) * length),
            reason: None,
            ..none(NoForce::NoState)
        }
    }
}
