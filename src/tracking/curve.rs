//! Curve of the whisker in each frame, in millimetres with the y axis upward.

use super::frame_curve::FrameCurve;
use super::options::{FaceAxis, TrackingError, TrackingOptions};
use super::rods::{self, NoRods};
use super::sample::evenly;
use super::{CurvedFrame, ImageFrame, MORE_POINTS, NoFrame, Remarks};
use crate::quantile::median;
use crate::scene::{LENGTH_MM, digits, rounded};
use crate::traced::{MOST_DEGREE, TracedShape, common_degree};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicBool, Ordering};
use whiskmap_mechanics::rod::{CURVATURE_TERMS, CurvaturePolynomial};

/// Number of points from which on cross-validation chooses the degree.
const MANY_POINTS: usize = 8;

/// Number of frames, from all over the film, whose points choose the degree together.
const CHOSEN_FRAMES: usize = 40;

/// Part of the median length, from the base on, whose points give base angle and curvature. A loaded whisker bends most beyond it, where it is
/// thin; a polynomial that follows the whole whisker has a wrong angle at its end.
const NEAR: f64 = 0.6;

/// Angle by which a whisker turns from base to tip at least, in radians, to have a concave side.
const STRAIGHT: f64 = 0.02;

/// Usual difference of the angle at the follicle from that of the arc through follicle and tip, in radians: the curvature of a whisker is not constant.
const USUAL_MEAN: f64 = PI / 12.0;

/// Usual scatter of this difference in a film, in radians. From a wrong axis, the difference changes by twice the angle of the base.
const USUAL_SCATTER: f64 = PI / 60.0;

/// Smallest difference of the misfits of two axes that shows which one is right.
const SHOWN: f64 = 0.25;

/// Least mean difference that is unlikely, in radians.
const UNLIKELY_MEAN: f64 = PI / 6.0;

/// Frames with what their curves need.
pub(super) struct Curves<'a> {
    frames: &'a [ImageFrame],
    mm_per_pixel: f64,
    /// Curve of each frame, `[frame]`.
    curves: Vec<Result<FrameCurve, NoFrame>>,
    is_mirrored: bool,
    /// What a frame with a curve has, for messages.
    pub needs: String,
}

impl<'a> Curves<'a> {
    /// Computes the curve of each frame, and adds notes on how.
    pub fn new(
        frames: &'a [ImageFrame],
        options: &TrackingOptions,
        cancel: &AtomicBool,
        remarks: &mut Remarks,
    ) -> Result<Self, TrackingError> {
        let scale = options.mm_per_pixel;
        let mut is_unlike = false;
        let (curves, needs) = if frames.iter().any(|frame| frame.bend.is_some()) {
            let axis = face_axis(frames, options.face_axis, remarks);
            let arcs = frames.iter().map(|frame| arc(frame, axis, scale));
            (arcs.collect(), "angle, curvature, follicle and tip".to_owned())
        } else {
            if let Some(axis) = options.face_axis {
                let must = "must be left out: only measurements of whisk have angles".to_owned();
                return Err(super::refused("face_axis", axis.name(), must));
            }
            match rods::curves(frames, options, cancel, remarks) {
                Ok(rods) => (rods, smooth_points(MORE_POINTS + 1)),
                Err(why) => {
                    is_unlike = matches!(why, NoRods::Unlike(_));
                    traced_frames(frames, options, &why, cancel, remarks)
                }
            }
        };
        let curves: Vec<Result<FrameCurve, NoFrame>> = curves;
        let length_mm = median(curves.iter().flatten().map(|curve| curve.length_mm));
        let [least, most] = LENGTH_MM;
        if length_mm < least || length_mm > most {
            let [length, least, most, scale] =
                [rounded(length_mm, 3), least, most, scale].map(digits);
            remarks.warnings.push(format!(
                "curves are {length} mm long (median): expected {least} to {most} mm; mm_per_pixel = {scale} is the size of a pixel, not the number of pixels in 1 mm"
            ));
        }
        let turn = median(curves.iter().flatten().map(FrameCurve::turn));
        let is_mirrored = options.mirror.unwrap_or(!is_unlike && turn < -STRAIGHT);
        if is_mirrored && options.mirror.is_none() {
            let degrees = -turn.to_degrees();
            remarks.notes.push(format!(
                "the image is mirrored, so that the concave side is CF: from base to tip, the whisker turns clockwise, by {degrees:.1} deg (median)"
            ));
        }
        Ok(Self { frames, mm_per_pixel: scale, curves, is_mirrored, needs })
    }

    /// Returns the frames with these numbers, mirrored if need be; frames that the file does not have are gaps.
    pub fn of_frames(self, numbers: RangeInclusive<u64>) -> Vec<CurvedFrame> {
        let y_scale = if self.is_mirrored { self.mm_per_pixel } else { -self.mm_per_pixel };
        let mm = |[x, y]: [f64; 2]| [self.mm_per_pixel * x, y_scale * y];
        let mut frames = self.frames.iter().zip(self.curves).peekable();
        let frame = |number: u64| {
            let lost = CurvedFrame {
                number,
                curve: Err(NoFrame::Missing),
                points_mm: Vec::new(),
                pole_mm: None,
            };
            let Some((frame, curve)) = frames.next_if(|(frame, _)| frame.number == number) else {
                return lost;
            };
            let curve = match self.is_mirrored {
                true => curve.map(FrameCurve::mirrored),
                false => curve,
            };
            let points = frame.points_px.iter().flatten().map(|point| mm(*point));
            CurvedFrame {
                points_mm: if curve.is_ok() { points.collect() } else { Vec::new() },
                pole_mm: frame.pole_px.map(mm),
                curve,
                ..lost
            }
        };
        numbers.map(frame).collect()
    }
}

/// Number of points along a whisker below which a warning says that they are few. With 8 exact points along the cone of `cone.toml`, detachments
/// were off by up to 7 degrees, with 10 by 2, with 12 by 0.7, and with 16 by 0.4.
const ENOUGH_POINTS: f64 = 12.0;

/// Returns what a frame with a curve has, for messages.
fn smooth_points(count: usize) -> String {
    format!("{count} points along a smooth curve, the base among them")
}

/// The curves through the points of all frames: near the base, and whole. All frames have the same degrees. Also returns what a frame with
/// a curve has, for messages.
fn traced_frames(
    frames: &[ImageFrame],
    options: &TrackingOptions,
    why: &NoRods,
    cancel: &AtomicBool,
    remarks: &mut Remarks,
) -> (Vec<Result<FrameCurve, NoFrame>>, String) {
    let points: Vec<Option<Vec<[f64; 2]>>> =
        frames.iter().map(|frame| frame.points_mm(options.mm_per_pixel)).collect();
    let known = || points.iter().flatten();
    let far = |points: &[[f64; 2]], i: usize| {
        libm::hypot(points[i][0] - points[0][0], points[i][1] - points[0][1])
    };
    let length = |points: &Vec<[f64; 2]>| {
        let steps = points.windows(2);
        steps.map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum::<f64>()
    };
    let length_mm = median(known().map(length));
    let few = median(known().map(|points| far(points, (MANY_POINTS - 1).min(points.len() - 1))));
    // A little more, so that rounding leaves no point out.
    let reach_mm =
        options.fit_to_mm.unwrap_or_else(|| (NEAR * length_mm).max(few + 1e-3 * length_mm));
    let near = |points: &Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        let first = points.iter().enumerate().take_while(|(i, _)| far(points, *i) <= reach_mm);
        first.map(|(_, point)| *point).collect()
    };
    let points_each = median(known().map(|points| points.len() as f64));
    let are_few = points_each < ENOUGH_POINTS;
    if are_few {
        let or = if options.pole.is_none() { ", or 5 with `pole`" } else { "" };
        remarks.warnings.push(format!(
            "{points_each} points along the whisker are few: angles and curvatures of a bent whisker may be far off; {ENOUGH_POINTS} or more are enough{or}"
        ));
    }
    let shows_contact = match why {
        NoRods::Selected => true,
        NoRods::Few { .. } => !are_few,
        NoRods::Unlike(_) => false,
    };
    remarks.warnings.extend(why.warning(shows_contact));
    let notes = &mut remarks.notes;
    let mut degree_of = |shapes: Vec<Vec<[f64; 2]>>, what: &str| {
        options.degree.unwrap_or_else(|| degree(&shapes, what, cancel, notes))
    };
    let part = digits(rounded(reach_mm, 3));
    let near_degree =
        degree_of(known().map(near).collect(), &format!("near the base, up to {part} mm from it,"));
    let whole_degree = degree_of(known().cloned().collect(), "of whole whiskers");
    let frame = |points: &Option<Vec<[f64; 2]>>| {
        let whole = points.as_ref().ok_or(NoFrame::Missing)?;
        let fit = |points: Vec<[f64; 2]>, degree: usize| {
            let is_enough = points.len() >= degree + MORE_POINTS;
            if !is_enough || cancel.load(Ordering::Relaxed) {
                return Err(NoFrame::Missing);
            }
            TracedShape::fit_until(points, Some(degree), cancel).map_err(|_| NoFrame::NoCurve)
        };
        let near = fit(near(whole), near_degree)?;
        let whole = fit(whole.clone(), whole_degree)?;
        let curve = FrameCurve::traced(&near, &whole);
        Ok(if shows_contact { curve } else { curve.hiding_contact() })
    };
    let mut needs = smooth_points(MORE_POINTS + near_degree);
    if known().next().is_some() {
        needs += &format!(
            " and all within {part} mm of it; a curvature of degree {near_degree} needs as many"
        );
    }
    (points.par_iter().map(frame).collect(), needs)
}

/// The degree for all frames: by cross-validation in some frames together, or one that leaves points over.
fn degree(
    shapes: &[Vec<[f64; 2]>],
    what: &str,
    cancel: &AtomicBool,
    notes: &mut Vec<String>,
) -> usize {
    let many: Vec<_> = shapes.iter().filter(|shape| shape.len() >= MANY_POINTS).collect();
    // Cross-validation in a few frames does not speak for all.
    let (degree, how) = if 2 * many.len() <= shapes.len() {
        let count = median(shapes.iter().map(|shape| shape.len() as f64)) as usize;
        let degree = count.saturating_sub(MORE_POINTS) / 2;
        (degree.min(MOST_DEGREE), format!("for {count} points"))
    } else {
        let count = many.len().min(CHOSEN_FRAMES);
        let some: Vec<_> = evenly(&many, count).into_iter().cloned().collect();
        let degree = common_degree(&some, cancel).unwrap_or_default();
        (degree, format!("chosen by cross-validation in {count} frames"))
    };
    notes.push(format!("curves {what} have a curvature of degree {degree}, {how}"));
    degree
}

/// Follicle, chord and mean curvature (in 1/px) of a measured segment, in the axes of the image; and its angle in degrees.
fn measured(frame: &ImageFrame) -> Option<(DVec2, DVec2, f64, f64)> {
    let [Some(follicle), Some(tip)] = frame.points_px[..] else {
        return None;
    };
    let [angle, curvature] = frame.bend?;
    let follicle = DVec2::from(follicle);
    Some((follicle, DVec2::from(tip) - follicle, curvature, angle))
}

/// Half the angle by which an arc of this curvature turns over its chord; `None` if there is no such arc.
fn half_turn(chord: DVec2, curvature: f64) -> Option<f64> {
    let sine = 0.5 * curvature * chord.length();
    (sine.abs() <= 1.0).then(|| libm::asin(sine))
}

/// Angle of the tangent in radians from the x axis toward the y axis of the image, of an angle in degrees from `axis`.
fn from_x(angle_deg: f64, axis: FaceAxis) -> f64 {
    match axis {
        FaceAxis::X => angle_deg.to_radians(),
        FaceAxis::Y => FRAC_PI_2 - angle_deg.to_radians(),
    }
}

/// Difference between the angles at the follicle, measured from an axis, and those of arcs through the ends of the segments.
struct AxisFit {
    axis: FaceAxis,
    /// Mean difference, in radians.
    mean: f64,
    /// Sum of squares of the mean and of the scatter, over those that are usual.
    misfit: f64,
}

impl AxisFit {
    fn of(frames: &[ImageFrame], axis: FaceAxis) -> Self {
        let differences = frames.iter().filter_map(|frame| {
            let (_, chord, curvature, angle) = measured(frame)?;
            let base = libm::atan2(chord.y, chord.x) - half_turn(chord, curvature)?;
            Some(DVec2::from_angle(from_x(angle, axis) - base))
        });
        let differences: Vec<DVec2> = differences.collect();
        let mean = differences.iter().copied().sum::<DVec2>().to_angle();
        let off = differences.iter().map(|one| DVec2::from_angle(mean).angle_to(*one).powi(2));
        let scatter = off.sum::<f64>() / differences.len().max(1) as f64;
        let misfit = (mean / USUAL_MEAN).powi(2) + scatter / USUAL_SCATTER.powi(2);
        Self { axis, mean, misfit }
    }
}

/// Returns the axis from which the angles of segments are measured: the given one, or that with the smaller misfit. A warning says if that is in doubt.
fn face_axis(
    frames: &[ImageFrame],
    given: Option<FaceAxis>,
    Remarks { notes, warnings }: &mut Remarks,
) -> FaceAxis {
    let [x, y] = [FaceAxis::X, FaceAxis::Y].map(|axis| AxisFit::of(frames, axis));
    let is_x = given.map_or(x.misfit < y.misfit, |axis| axis == FaceAxis::X);
    let [taken, other] = if is_x { [x, y] } else { [y, x] };
    let names = [&taken, &other].map(|fit| fit.axis.name());
    let found = if given.is_some() { "" } else { ", as the ends of the segments show" };
    notes.push(format!("angles are measured from the {} axis of the image{found}", names[0]));
    if given.is_some() && taken.misfit > other.misfit + SHOWN {
        warnings.push(format!(
            "the ends of the segments fit angles from the {} axis better: check `face_axis`",
            names[1]
        ));
    } else if given.is_none() && taken.misfit > other.misfit - SHOWN {
        warnings.push(format!(
            "the ends of the segments hardly show that angles are not measured from the {} axis: give `face_axis`",
            names[1]
        ));
    } else if taken.mean.abs() > UNLIKELY_MEAN {
        warnings.push(format!(
            "angles at the follicle differ by {:.0} deg from those of arcs through follicle and tip (mean): check `face_axis` and the signs of angle and curvature",
            taken.mean.abs().to_degrees()
        ));
    }
    taken.axis
}

/// The arc of a measured segment, with the y axis upward.
fn arc(frame: &ImageFrame, axis: FaceAxis, scale: f64) -> Result<FrameCurve, NoFrame> {
    let (follicle, chord, curvature, angle) = measured(frame).ok_or(NoFrame::Missing)?;
    let half =
        half_turn(chord, curvature).filter(|_| chord.length() > 0.0).ok_or(NoFrame::NoCurve)?;
    let length = match half {
        0.0 => chord.length(),
        _ => 2.0 * half / curvature,
    };
    let mut legendre = [0.0; CURVATURE_TERMS];
    legendre[0] = -2.0 * half;
    Ok(FrameCurve::arc(
        scale * DVec2::new(follicle.x, -follicle.y),
        -from_x(angle, axis),
        CurvaturePolynomial::new(legendre),
        scale * length,
    ))
}
