//! Numbers that are known otherwise: published, in closed form, or from an independent solver.

use super::elastica::{elastica, fold};
use super::reference;
use super::whiskers::{CONE, CYLINDER, POLE_MM, fig2_distance_mm, whisker};
use crate::model::{Side, Units};
use crate::scene::Whisker;
use crate::trace::{Branch, Detachment, Kind, NoState, corner, curve};

/// A number that is known, and the same number computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Of what.
    pub case: String,
    /// Which quantity, with its unit.
    pub quantity: &'static str,
    /// Where it is known from.
    pub source: &'static str,
    /// What it should be.
    pub expected: Expected,
    /// What it is.
    pub computed: f64,
}

/// What a number should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// A value, up to a tolerance: half of the last digit known, unless a check says otherwise.
    Near(f64, f64),
    /// More than a value.
    Above(f64),
}

impl Check {
    /// How far the number is from where it should be; 0 inside of an open range.
    #[must_use]
    pub fn difference(&self) -> f64 {
        match self.expected {
            Expected::Near(value, _) => (self.computed - value).abs(),
            Expected::Above(bound) if self.computed > bound => 0.0,
            Expected::Above(bound) => bound - self.computed,
        }
    }

    /// Whether the number is what it should be; NaN never is.
    #[must_use]
    pub fn passes(&self) -> bool {
        match self.expected {
            Expected::Near(_, tolerance) => self.difference() <= tolerance,
            Expected::Above(bound) => self.computed > bound,
        }
    }
}

const PAPER: &str = "paper";
const AUTO: &str = "AUTO-07p";
const CLOSED: &str = "closed form";
const EXACT: &str = "symmetry";

/// Every check, in the order of a reader.
#[must_use]
pub fn checks() -> Vec<Check> {
    let mut checks = paper();
    checks.extend(straight_cylinder());
    checks.extend(straight_cone());
    checks.extend(symmetries());
    checks.extend(reference::checks());
    checks
}

fn near(
    case: impl Into<String>,
    quantity: &'static str,
    source: &'static str,
    (expected, tolerance): (f64, f64),
    computed: Option<f64>,
) -> Check {
    Check {
        case: case.into(),
        quantity,
        source,
        expected: Expected::Near(expected, tolerance),
        computed: computed.unwrap_or(f64::NAN),
    }
}

/// The end of the push at one distance.
fn end(whisker: &Whisker, pole_mm: f64, side: Side, distance_mm: f64) -> Detachment {
    curve(whisker, pole_mm, side, &[distance_mm])[0]
}

fn push_if(kind: Kind, end: &Detachment) -> Option<f64> {
    end.push_angle_deg.filter(|_| end.kind == kind)
}

fn paper() -> Vec<Check> {
    let mut checks = Vec::new();
    for (case, whisker, kind, quantity, published, exact) in [
        (
            "Fig. 2B, cone CB",
            CONE,
            Kind::SlipOff,
            "slip-off (deg)",
            (15.6, 0.05),
            (15.59975, 5e-6),
        ),
        (
            "Fig. 2D, cylinder CB",
            CYLINDER,
            Kind::PullOff,
            "pull-off (deg)",
            (62.7, 0.1),
            (62.7532, 5e-5),
        ),
    ] {
        let end = end(&whisker, POLE_MM, Side::Cb, fig2_distance_mm(&whisker));
        let push = push_if(kind, &end);
        checks.push(near(case, quantity, PAPER, published, push));
        checks.push(near(case, quantity, AUTO, exact, push));
    }
    for (case, side, values) in [
        (
            "cone CB, touched at 15.66 mm",
            Side::Cb,
            [
                (15.60793, 5e-6),
                (17.4303, 5e-5),
                (1.2898, 5e-5),
                (5.5572, 5e-5),
            ],
        ),
        (
            "cone CF, touched at 15.66 mm",
            Side::Cf,
            [
                (-24.9168, 5e-5),
                (16.3284, 5e-5),
                (2.958, 5e-4),
                (-25.70, 5e-3),
            ],
        ),
    ] {
        let end = end(&CONE, POLE_MM, side, 15.660_459_763_365_8);
        let quantities = [
            ("slip-off (deg)", push_if(Kind::SlipOff, &end)),
            ("contact s_obj (mm)", end.arc_length_mm),
            ("force (uN)", end.force_un),
            ("base moment (nN m)", end.base_moment_nnm),
        ];
        for ((quantity, computed), expected) in quantities.into_iter().zip(values) {
            checks.push(near(case, quantity, AUTO, expected, computed));
        }
    }
    checks.push(near(
        "cone CB",
        "slip-off turns into pull-off at (mm)",
        AUTO,
        (19.09, 5e-3),
        corner(&CONE, POLE_MM, Side::Cb).distance_mm,
    ));
    let cylinder = |side| end(&CYLINDER, POLE_MM, side, 10.0).push_angle_deg;
    checks.push(near(
        "cylinder CB, touched at 10 mm",
        "slip-off (deg)",
        AUTO,
        (89.22, 5e-3),
        cylinder(Side::Cb),
    ));
    checks.push(Check {
        case: "cylinder CF, touched at 10 mm".to_owned(),
        quantity: "slip-off, magnitude (deg)",
        source: PAPER,
        expected: Expected::Above(90.0),
        computed: cylinder(Side::Cf).map_or(f64::NAN, f64::abs),
    });
    checks
}

const STRAIGHT_CYLINDER: Whisker = whisker([20.0, 30.0, 30.0], 0.0, 0.0);
const STRAIGHT_CONE: Whisker = whisker([20.0, 30.0, 0.0], 0.0, 0.0);
const STRAIGHT_WHISKER: Whisker = whisker([20.0, 30.0, 1.5], 0.0, 0.0);

fn straight_cylinder() -> Vec<Check> {
    let case = "straight cylinder, point contact";
    let end = end(&STRAIGHT_CYLINDER, 0.0, Side::Cb, 8.0);
    let arc = end.arc_length_mm.map(|arc| arc / 8.0);
    let corner = corner(&STRAIGHT_CYLINDER, 0.0, Side::Cb);
    let mut checks = vec![
        near(
            case,
            "slip-off (deg)",
            CLOSED,
            (fold().push.to_degrees(), 1e-10),
            end.push_angle_deg,
        ),
        // Where the push is largest, the arc is known to the root of the rounding only.
        near(
            case,
            "s_obj/d at slip-off",
            CLOSED,
            (fold().arc_over_distance, 5e-9),
            arc,
        ),
        near(
            case,
            "pulled off beyond d/L_w",
            CLOSED,
            (1.0 / fold().arc_over_distance, 5e-9),
            corner
                .distance_mm
                .map(|mm| mm / STRAIGHT_CYLINDER.length_mm),
        ),
    ];
    let exact = elastica(60_f64.to_radians());
    let state = turned(&STRAIGHT_CYLINDER, 8.0, exact.push).ok();
    let case = "straight cylinder, turned by 60 deg";
    checks.push(near(
        case,
        "s_obj/d",
        CLOSED,
        (exact.arc_over_distance, 1e-12),
        state.map(|(arc, _)| arc),
    ));
    checks.push(near(
        case,
        "F d^2/(E I)",
        CLOSED,
        (exact.load, 1e-12),
        state.map(|(_, load)| load),
    ));
    checks
}

/// `s_obj/d` and `F d^2/(E I)` of a straight cylinder touched by a point at `distance_mm`, after a push in radians.
pub fn turned(cylinder: &Whisker, distance_mm: f64, push: f64) -> Result<(f64, f64), NoState> {
    let branch = Branch::new(cylinder, 0.0, Side::Cb, distance_mm)?;
    let state = branch.state(push, true)?;
    let distance = distance_mm / cylinder.length_mm;
    Ok((state.tau / distance, state.load * distance * distance))
}

/// The limit of small loads: `M = 3 E I_base theta (L - a)/(a L)`, `L` the virtual cone's length; the next term is
/// smaller by the square of the angle.
fn straight_cone() -> Vec<Check> {
    let push = 1e-5;
    [
        ("perfect cone", STRAIGHT_CONE),
        ("truncated cone", STRAIGHT_WHISKER),
    ]
    .into_iter()
    .flat_map(|(name, cone)| [5.0, 15.0].map(|a| (name, cone.clone(), a)))
    .map(|(name, cone, a)| {
        let length = cone.length_mm / (1.0 - cone.tip_radius_um / cone.base_radius_um);
        let units = Units::new(&cone);
        let exact = 3.0 * units.moment_nnm * cone.length_mm * push * (length - a) / (a * length);
        let moment = Branch::new(&cone, 0.0, Side::Cb, a)
            .and_then(|branch| Ok((branch.state(push, true)?, branch)))
            .map(|(state, branch)| branch.read(&state).base_moment_nnm);
        near(
            format!("straight {name} at a = {a} mm, small load"),
            "base moment over formula",
            CLOSED,
            (1.0, 1e-8),
            moment.ok().map(|moment| moment / exact),
        )
    })
    .collect()
}

fn symmetries() -> Vec<Check> {
    let push = |whisker: &Whisker, pole, side, d| end(whisker, pole, side, d).push_angle_deg;
    let sum = |a: Option<f64>, b: Option<f64>, sign: f64| Some(a? + sign * b?);
    let scaled = whisker([1000.0, 1500.0, 75.0], 4e-4, 0.0);
    let mut soft = CONE;
    soft.youngs_modulus_gpa = 1.0;
    let mut thin = CYLINDER;
    (thin.base_radius_um, thin.tip_radius_um) = (3.0, 3.0);
    let distances: Vec<f64> = (1..=64).map(|i| 0.3 * f64::from(i)).collect();
    let pulled = Side::BOTH
        .iter()
        .flat_map(|side| {
            curve(
                &whisker([20.0, 30.0, 0.0], 0.02, 0.0),
                POLE_MM,
                *side,
                &distances,
            )
        })
        .filter(|end| end.kind == Kind::PullOff)
        .count();
    let cone = push(&CONE, POLE_MM, Side::Cb, 14.0);
    let mirror = |side| push(&STRAIGHT_WHISKER, POLE_MM, side, 14.0);
    vec![
        near(
            "straight whisker",
            "slip-off, CB and CF together (deg)",
            EXACT,
            (0.0, 0.0),
            sum(mirror(Side::Cb), mirror(Side::Cf), 1.0),
        ),
        near(
            "cone, Young's modulus over 3",
            "slip-off, change (deg)",
            EXACT,
            (0.0, 0.0),
            sum(push(&soft, POLE_MM, Side::Cb, 14.0), cone, -1.0),
        ),
        near(
            "cylinder, radius over 10",
            "pull-off, change (deg)",
            EXACT,
            (0.0, 0.0),
            sum(
                push(&thin, POLE_MM, Side::Cb, 14.0),
                push(&CYLINDER, POLE_MM, Side::Cb, 14.0),
                -1.0,
            ),
        ),
        near(
            "cone, every length times 50",
            "slip-off, change (deg)",
            EXACT,
            (0.0, 1e-10),
            sum(push(&scaled, 50.0 * POLE_MM, Side::Cb, 700.0), cone, -1.0),
        ),
        #[allow(clippy::cast_precision_loss, reason = "at most 128")]
        near(
            "perfect cone, 128 pushes",
            "pull-offs",
            EXACT,
            (0.0, 0.0),
            Some(pulled as f64),
        ),
    ]
}
