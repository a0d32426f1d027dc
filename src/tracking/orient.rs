//! Order of points along the whisker, and the end at its base.

use super::options::{TrackingError, TrackingOptions, refused};
use super::{ImageFrame, ImageFrames, PointOrder};
use crate::quantile::median;

/// Ratio of the scatters of both ends from which on the steadier one is the base. The tip of a whisker of 20 mm whose base turns by 1 degree
/// moves by 0.35 mm.
const STEADIER: f64 = 2.0;

/// Number of frames, from all over the film, from which the order of named points is found.
const ORDER_FRAMES: usize = 1000;

/// Detour over a point between its two neighbours, in parts of the way past it, from which on the point may be beside the whisker: a turn by 35
/// degrees.
const DETOUR: f64 = 0.05;

/// Median detours of a film by which that over a point beside the whisker is larger at least.
const DETOURS: f64 = 10.0;

/// Orders the points of all frames from base to tip.
///
/// # Errors
/// If both ends move about equally, and the options do not give the follicle.
pub(super) fn order(
    image: &mut ImageFrames,
    options: &TrackingOptions,
) -> Result<(), TrackingError> {
    match &image.order {
        PointOrder::FromBase => return Ok(()),
        PointOrder::Named(names) => {
            let beside = chain(&mut image.frames, names);
            image.remarks.warnings.extend(beside.into_iter().map(|name| {
                format!(
                    "body part {name} is beside the whisker in most frames: give the parts along the whisker by `points`, and the pole by `pole`"
                )
            }));
        }
        PointOrder::Along => align(&mut image.frames),
    }
    let ends = [0, 1].map(|end| places(&image.frames, end));
    let is_flipped = match options.follicle_px {
        Some(follicle) => {
            let far = ends
                .each_ref()
                .map(|positions| median(positions.iter().map(|at| distance(*at, follicle))));
            far[1] < far[0]
        }
        None if ends.iter().any(|positions| positions.len() < 2) => {
            image.remarks.notes.push("one frame does not show the base: points are taken from base to tip as they are given".to_owned());
            false
        }
        None => {
            let spreads = ends.each_ref().map(|positions| spread(positions));
            let [first, last] = spreads;
            if STEADIER * first > last && STEADIER * last > first {
                let must = format!(
                    "must be given: both ends of the whisker move about equally, by {first:.2} and {last:.2} px"
                );
                return Err(refused("follicle_px", "(left out)", must));
            }
            last < first
        }
    };
    if is_flipped {
        for frame in &mut image.frames {
            frame.points_px.reverse();
        }
    }
    let base = places(&image.frames, 0);
    let [x, y] = centre(&base);
    image.remarks.notes.push(format!(
        "base at {x:.1},{y:.1} px; it moves by {:.2} px, the tip by {:.2} px (medians)",
        spread(&base),
        spread(&places(&image.frames, 1))
    ));
    Ok(())
}

/// Orders named points along the whisker, from one of the two that are farthest apart. The first point of the file stays in the first half.
/// Points that are lost in all frames are left out. Returns those of their `names` whose points are beside the line of the others.
fn chain<'a>(frames: &mut [ImageFrame], names: &'a [String]) -> Vec<&'a str> {
    let count = frames.first().map_or(0, |frame| frame.points_px.len());
    let is_seen = |i: &usize| frames.iter().any(|frame| frame.points_px[*i].is_some());
    let seen: Vec<usize> = (0..count).filter(is_seen).collect();
    let step = frames.len().div_ceil(ORDER_FRAMES);
    let far = |a: usize, b: usize| {
        let some = frames.iter().step_by(step);
        median(some.filter_map(|frame| Some(distance(frame.points_px[a]?, frame.points_px[b]?))))
    };
    let pairs = seen
        .iter()
        .flat_map(|a| seen.iter().filter(move |b| a < *b).map(move |b| (*a, *b)))
        .map(|(a, b)| (a, far(a, b)));
    let farthest = pairs.max_by(|(_, one), (_, other)| one.total_cmp(other));
    let Some((end, _)) = farthest else {
        return Vec::new();
    };
    let mut order: Vec<(usize, f64)> = seen.iter().map(|i| (*i, far(end, *i))).collect();
    order.sort_by(|(_, one), (_, other)| one.total_cmp(other));
    let first = order.iter().position(|(i, _)| *i == seen[0]);
    if first.is_some_and(|first| 2 * first >= order.len()) {
        order.reverse();
    }
    let order: Vec<usize> = order.into_iter().map(|(i, _)| i).collect();
    let detours = order.windows(3).map(|three| {
        let detour = |frame: &ImageFrame| {
            let [before, at, after] = [0, 1, 2].map(|i| frame.points_px[three[i]]);
            let (before, at, after) = (before?, at?, after?);
            let length = distance(before, at) + distance(at, after);
            Some(length / distance(before, after) - 1.0)
        };
        let some = frames.iter().step_by(step);
        (three[1], median(some.filter_map(detour)))
    });
    let detours: Vec<(usize, f64)> = detours.collect();
    let usual = median(detours.iter().map(|(_, detour)| *detour));
    let is_beside = |(_, detour): &&(usize, f64)| *detour > DETOUR.max(DETOURS * usual);
    let beside = detours.iter().filter(is_beside);
    let beside = beside.map(|(i, _)| &*names[*i]).collect();
    for frame in frames {
        frame.points_px = order.iter().map(|i| frame.points_px[*i]).collect();
    }
    beside
}

/// Turns the points of frames around whose ends are nearer to the other ends of the last frame that has each. A lost end does not count.
fn align(frames: &mut [ImageFrame]) {
    let mut before = [None; 2];
    for frame in frames {
        let [first, last] = ends(frame);
        let apart = |end: Option<[f64; 2]>, other: Option<[f64; 2]>| {
            let pair = end.zip(other);
            pair.map_or(0.0, |(end, other)| distance(end, other))
        };
        let straight = apart(first, before[0]) + apart(last, before[1]);
        let crossed = apart(first, before[1]) + apart(last, before[0]);
        if crossed < straight {
            frame.points_px.reverse();
        }
        let [first, last] = ends(frame);
        before = [first.or(before[0]), last.or(before[1])];
    }
}

/// First and last point of the whisker in a frame; `None` if it is lost.
fn ends(frame: &ImageFrame) -> [Option<[f64; 2]>; 2] {
    let points = &frame.points_px;
    [points.first(), points.last()].map(|point| point.copied().flatten())
}

/// Positions of the first (0) or the last (1) point in all frames that have it.
fn places(frames: &[ImageFrame], end: usize) -> Vec<[f64; 2]> {
    frames.iter().filter_map(|frame| ends(frame)[end]).collect()
}

fn distance([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    libm::hypot(x - u, y - v)
}

/// Median position, by coordinate.
fn centre(places: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| median(places.iter().map(|place| place[axis])))
}

/// Median distance of positions from their median.
fn spread(places: &[[f64; 2]]) -> f64 {
    let centre = centre(places);
    median(places.iter().map(|place| distance(*place, centre)))
}
