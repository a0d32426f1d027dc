//! Detachment curves, branches and shapes, computed in memory.

use super::{Error, Options, accuracy};
use crate::scene::{Scene, SweepPlace};
use crate::sensitivity::detachments_of_sides_until;
use crate::trace::{
    Branch, Detachment, NoState, StableBranch, SweptSide, WhiskerShape, sides, whiskers_at_once,
};
use std::sync::atomic::AtomicBool;
use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Resolution;

/// Maximum number of distances of a side that are computed together.
const DISTANCES_AT_ONCE: usize = 4096;

/// Computes where every whisker of `scene` detaches: at each distance, CF before CB.
///
/// ```
/// use whiskmap::trace::DetachmentKind;
/// use whiskmap::{Options, scene::Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let curve = whiskmap::curve(&cone.to_builder().distance_mm([15.6604597633658]).build()?, Options::default())?;
/// let (_, cb) = &curve[1];
/// assert_eq!(cb.kind, DetachmentKind::SlipOff);
/// assert!(cb.push_angle_deg.is_some_and(|push| (push - 15.60793).abs() < 1e-5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tolerance cannot be kept, or the computation is cancelled.
pub fn curve(scene: &Scene, options: Options) -> Result<Vec<(SweepPlace, Detachment)>, Error> {
    let accuracy = accuracy(scene, options.tolerance_deg, &Side::BOTH)?;
    let resolution = accuracy.map_or(Resolution::FINE, |accuracy| accuracy.resolution);
    let distances = &scene.grid.distance_mm;
    let never = AtomicBool::new(false);
    let cancel = options.cancel.as_deref().unwrap_or(&never);
    let of_sides = |sides: &[SweptSide]| {
        let mut ends = vec![Vec::with_capacity(distances.len()); sides.len()];
        for part in distances.chunks(DISTANCES_AT_ONCE) {
            let Some(found) = detachments_of_sides_until(resolution, sides, part, &[], cancel)
            else {
                break;
            };
            for (ends, found) in ends.iter_mut().zip(found) {
                ends.extend(found.into_iter().map(|found| found.end));
            }
        }
        ends
    };
    let mut ends = Vec::with_capacity(2 * scene.whisker_count() * distances.len());
    for group in scene.whisker_groups(whiskers_at_once(distances.len())) {
        ends.extend(sides(&group, distances.len(), of_sides));
        if options.is_cancelled() {
            return Err(Error::Cancelled);
        }
    }
    Ok(ends)
}

/// Computes the branch of the scene's first whisker at one pole, from first touch at `distance_mm` through the fold.
///
/// ```
/// use whiskmap::{Side, scene::Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let points = whiskmap::branch(&cone, 15.66, Side::Cb)?.points(50)?;
/// assert!(points[0].stable && !points[49].stable);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the whisker at rest does not reach the pole, or the continuation fails.
pub fn branch(scene: &Scene, distance_mm: f64, side: Side) -> Result<Branch, NoState> {
    let first = scene.first_whisker();
    Branch::new(&first.whisker, &first.pole, side, distance_mm)
}

/// Computes the stable shape of the scene's first whisker, at 200 points, after a push from first touch at `distance_mm`.
///
/// ```
/// use whiskmap::scene::Scene;
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// assert!(whiskmap::shape(&cone, 15.66, 10.0).is_ok());
/// let slipped = whiskmap::shape(&cone, 15.66, 20.0).err();
/// assert!(slipped.is_some_and(|why| why.to_string().starts_with("slipped off at 15.6")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When there is no such state: the error contains how the whisker left the pole, and at which push angle.
pub fn shape(
    scene: &Scene,
    distance_mm: f64,
    push_angle_deg: f64,
) -> Result<WhiskerShape, NoState> {
    let first = scene.first_whisker();
    let side = Side::of_push(push_angle_deg);
    let branch = StableBranch::new(&first.whisker, &first.pole, side, distance_mm)?;
    Ok(branch.shape(&branch.state(push_angle_deg.to_radians())?, 200))
}
