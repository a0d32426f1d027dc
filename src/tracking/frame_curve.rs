//! Curve of the whisker in one frame, in millimetres: polynomials of the curvature, or a rod that is bent by the pole.

use super::bent::{BentPose, FrameFit, TrackedRod};
use crate::traced::TracedShape;
use glam::DVec2;
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;
use whiskmap_mechanics::rod::{CurvaturePolynomial, Rest, Rod};

/// Number of places along a curve at which the nearest one to the pole is looked for first.
const PLACES: u32 = 64;

/// Most Newton steps to the place that is nearest to the pole.
const MOST_STEPS: usize = 20;

/// Largest distance of the whisker from the pole at first touch that counts as rounding, in parts of the pole's distance.
const TOUCHES: f64 = 1e-9;

/// Curve in the plane of the image.
#[derive(Clone, Debug)]
struct PlaneCurve {
    /// Position of the base, in mm.
    base: DVec2,
    /// Angle of the tangent at the base, in radians, counterclockwise from the x axis.
    angle: f64,
    /// Curvature over the length.
    curvature: CurvaturePolynomial,
    /// Length of the curve, in mm.
    length_mm: f64,
}

/// Place on a curve that is nearest to the pole's centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestPlace {
    /// Position in the frame of the base, in mm.
    pub at_mm: DVec2,
    /// Angle of the tangent there from the base's, in radians.
    pub angle: f64,
    /// Distance of the pole's centre from the whisker, in mm, positive on its left.
    pub offset_mm: f64,
    /// True if the pole is ahead of the end of the curve, within 45 degrees and one length.
    pub is_ahead: bool,
}

/// Form of the curve of one frame.
#[derive(Clone, Debug)]
enum CurveForm {
    /// Curves of polynomial curvature: near the base, where a low degree is enough, and of the whole whisker.
    Polynomials { near: Arc<PlaneCurve>, whole: Arc<PlaneCurve> },
    /// Rod between base and contact, and its rest shape beyond.
    Bent { whisker: Arc<TrackedRod>, pose: BentPose, contact: NearestPlace },
}

/// Curve of a whisker in one frame.
#[derive(Clone, Debug)]
pub(super) struct FrameCurve {
    form: CurveForm,
    /// Rod that gives the curvature of a whisker at rest, as of one with a load.
    loaded: Option<(Arc<TrackedRod>, BentPose)>,
    /// True if the y axis of the form has the other sign.
    is_mirrored: bool,
    /// True if the curve shows whether the whisker touches the pole.
    pub shows_contact: bool,
    /// Length of the traced whisker, in mm.
    pub length_mm: f64,
    /// Root mean square of the points' distances from the curve, in mm; `None` without points.
    pub rms_mm: Option<f64>,
}

impl PlaneCurve {
    fn of(fit: &TracedShape) -> Self {
        Self {
            base: fit.base_mm.into(),
            angle: fit.base_angle,
            curvature: fit.curvature,
            length_mm: fit.length_mm,
        }
    }

    fn rest(&self) -> Rest {
        Rest::new(&Rod { polynomial: Some(Arc::new(self.curvature)), ..Rod::default() })
    }

    /// Returns the place that is nearest to a point in mm, in lengths of the curve, and the signed distance of the point in mm, positive on
    /// the left; by Newton's method from the nearest of some places.
    fn nearest(&self, rest: &Rest, point_mm: DVec2) -> (f64, f64) {
        let point = DVec2::from_angle(-self.angle).rotate(point_mm - self.base) / self.length_mm;
        let far = |s: f64| rest.at_arclength(s).0.distance_squared(point);
        let places = (0..=PLACES).map(|i| f64::from(i) / f64::from(PLACES));
        let first = places.min_by(|one, other| far(*one).total_cmp(&far(*other)));
        let mut s = first.unwrap_or_default();
        for _ in 0..MOST_STEPS {
            let (foot, tangent) = rest.at_arclength(s);
            let slowed = 1.0 - (point - foot).dot(tangent.perp()) * self.curvature.at(s);
            let next = (s + (point - foot).dot(tangent) / slowed.max(0.1)).clamp(0.0, 1.0);
            let step = (next - s).abs();
            s = next;
            if step < 4.0 * f64::EPSILON {
                break;
            }
        }
        let (foot, tangent) = rest.at_arclength(s);
        let side = tangent.perp_dot(point - foot).signum();
        (s, side * foot.distance(point) * self.length_mm)
    }
}

impl FrameCurve {
    /// Creates the curve of the arc from `base` with this length, both in mm, and this curvature over the length.
    pub fn arc(base: DVec2, angle: f64, curvature: CurvaturePolynomial, length_mm: f64) -> Self {
        let arc = Arc::new(PlaneCurve { base, angle, curvature, length_mm });
        Self::polynomials(Arc::clone(&arc), arc, length_mm, None)
    }

    /// Creates the curve of two polynomials: of the points near the base, and of all points.
    pub fn traced(near: &TracedShape, whole: &TracedShape) -> Self {
        let [near, fitted] = [near, whole].map(|shape| Arc::new(PlaneCurve::of(shape)));
        Self::polynomials(near, fitted, whole.length_mm, Some(whole.rms_mm))
    }

    /// Creates the curve of a rod that was fitted to a frame. `loaded` gives the curvature of a whisker at rest.
    pub fn rod(whisker: &Arc<TrackedRod>, found: &FrameFit, loaded: Option<&FrameFit>) -> Self {
        let (pose, scale) = (found.pose, whisker.length_mm);
        let (length_mm, rms_mm) = (scale * found.end, Some(scale * found.rms()));
        let Some(((at, angle), offset)) = pose.contact(whisker).zip(found.offset) else {
            let rest = Arc::new(PlaneCurve {
                base: scale * pose.base,
                angle: pose.angle,
                curvature: whisker.curvature,
                length_mm: scale,
            });
            return Self {
                loaded: loaded.map(|fit| (Arc::clone(whisker), fit.pose)),
                ..Self::polynomials(Arc::clone(&rest), rest, length_mm, rms_mm)
            };
        };
        let contact =
            NearestPlace { at_mm: scale * at, angle, offset_mm: scale * offset, is_ahead: false };
        Self {
            form: CurveForm::Bent { whisker: Arc::clone(whisker), pose, contact },
            loaded: None,
            is_mirrored: false,
            shows_contact: true,
            length_mm,
            rms_mm,
        }
    }

    const fn polynomials(
        near: Arc<PlaneCurve>,
        whole: Arc<PlaneCurve>,
        length_mm: f64,
        rms_mm: Option<f64>,
    ) -> Self {
        Self {
            form: CurveForm::Polynomials { near, whole },
            loaded: None,
            is_mirrored: false,
            shows_contact: true,
            length_mm,
            rms_mm,
        }
    }

    /// Returns the curve as one that does not show whether the whisker touches the pole.
    pub fn hiding_contact(self) -> Self {
        Self { shows_contact: false, ..self }
    }

    /// Returns the curve with the other sign of the y axis.
    pub fn mirrored(self) -> Self {
        Self { is_mirrored: !self.is_mirrored, ..self }
    }

    /// Returns a number that changes its sign with the y axis.
    fn signed(&self, number: f64) -> f64 {
        if self.is_mirrored { -number } else { number }
    }

    /// Returns a vector in the axes of the curve.
    fn turned(&self, vector: DVec2) -> DVec2 {
        DVec2::new(vector.x, self.signed(vector.y))
    }

    /// Returns the angle of the tangent at the base, in radians, counterclockwise from the x axis.
    pub fn angle(&self) -> f64 {
        self.signed(match &self.form {
            CurveForm::Polynomials { near, .. } => near.angle,
            CurveForm::Bent { pose, .. } => pose.angle,
        })
    }

    /// Returns the position of the base, in mm.
    fn base_mm(&self) -> DVec2 {
        self.turned(match &self.form {
            CurveForm::Polynomials { near, .. } => near.base,
            CurveForm::Bent { whisker, pose, .. } => whisker.length_mm * pose.base,
        })
    }

    /// Returns a point in the frame of the base, in mm.
    pub fn seen_from_base(&self, point_mm: [f64; 2]) -> DVec2 {
        DVec2::from_angle(-self.angle()).rotate(DVec2::from(point_mm) - self.base_mm())
    }

    /// Returns where a pole at the distance of `pole_mm` from the base first touches the curve: the pole's centre and the contact, in the frame of the
    /// base, in mm. `pole_mm` is near this place and in that frame, and `offset_mm` is the distance of the pole's centre from the curve, positive on
    /// its left. `None` if the curve does not reach that far.
    pub fn first_touch(&self, pole_mm: DVec2, offset_mm: f64) -> Option<[DVec2; 2]> {
        let axis = DVec2::from_angle(self.angle());
        let (base, mut pole) = (self.base_mm(), pole_mm);
        for _ in 0..MOST_STEPS {
            let place = self.nearest((base + axis.rotate(pole)).into());
            let off = place.offset_mm - offset_mm;
            let tangent = DVec2::from_angle(place.angle);
            let rounding = TOUCHES * pole_mm.length();
            if off.abs() <= rounding {
                let is_beside = (pole - place.at_mm).dot(tangent).abs() <= rounding;
                return is_beside.then_some([pole, place.at_mm]);
            }
            // The pole turns around the base.
            let slope = pole.perp().dot(tangent.perp());
            pole = DVec2::from_angle((-off / slope).clamp(-0.5, 0.5)).rotate(pole);
        }
        None
    }

    /// Returns the angle by which the whisker turns from base to tip, at rest if it is a rod, in radians, positive counterclockwise.
    pub fn turn(&self) -> f64 {
        self.signed(match &self.form {
            CurveForm::Polynomials { whole, .. } => whole.curvature.angle(1.0),
            CurveForm::Bent { whisker, .. } => whisker.curvature.angle(1.0),
        })
    }

    /// Returns the length of the part whose curvature is known, in mm: from the base on.
    pub fn near_mm(&self) -> f64 {
        match &self.form {
            CurveForm::Polynomials { near, .. } => near.length_mm,
            CurveForm::Bent { whisker, .. } => whisker.length_mm,
        }
    }

    /// Returns the curvature at the arclength `s_mm`, in 1/mm.
    pub fn curvature_per_mm(&self, s_mm: f64) -> f64 {
        let of_rod = |whisker: &TrackedRod, pose: &BentPose| {
            let (_, curvature) = pose.at(whisker, s_mm / whisker.length_mm);
            curvature / whisker.length_mm
        };
        self.signed(match (&self.form, &self.loaded) {
            (CurveForm::Bent { whisker, pose, .. }, _) | (_, Some((whisker, pose))) => {
                of_rod(whisker, pose)
            }
            (CurveForm::Polynomials { near, .. }, None) => {
                near.curvature.at(s_mm / near.length_mm) / near.length_mm
            }
        })
    }

    /// Returns the position at the arclength `s_mm` in the frame of the base, in mm.
    pub fn position_mm(&self, s_mm: f64) -> DVec2 {
        self.turned(match &self.form {
            CurveForm::Polynomials { near, .. } => {
                near.rest().at_arclength(s_mm / near.length_mm).0 * near.length_mm
            }
            CurveForm::Bent { whisker, pose, .. } => {
                let (position, _) = pose.at(whisker, s_mm / whisker.length_mm);
                position * whisker.length_mm
            }
        })
    }

    /// Returns the place of the whole whisker that is nearest to the pole's centre: the contact of a bent rod.
    pub fn nearest(&self, pole_mm: [f64; 2]) -> NearestPlace {
        let place = match &self.form {
            CurveForm::Bent { contact, .. } => *contact,
            CurveForm::Polynomials { near, whole } => {
                let rest = whole.rest();
                let pole = self.turned(pole_mm.into());
                let (s, offset_mm) = whole.nearest(&rest, pole);
                let (position, tangent) = rest.at_arclength(s);
                let position = position * whole.length_mm;
                let axis = DVec2::from_angle(whole.angle);
                let at = whole.base + axis.rotate(position);
                let away = pole - at;
                let is_along = away.dot(axis.rotate(tangent)) > FRAC_1_SQRT_2 * away.length();
                NearestPlace {
                    at_mm: DVec2::from_angle(-near.angle).rotate(at - near.base),
                    angle: whole.angle + whole.curvature.angle(s) - near.angle,
                    offset_mm,
                    is_ahead: is_along && s > 0.5 && away.length() <= whole.length_mm,
                }
            }
        };
        NearestPlace {
            at_mm: self.turned(place.at_mm),
            angle: self.signed(place.angle),
            offset_mm: self.signed(place.offset_mm),
            is_ahead: place.is_ahead,
        }
    }
}
