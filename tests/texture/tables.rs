//! Surfaces, shapes, stays and histograms.

use super::{SHIPPED, scene};
use whiskmap::Side;
use whiskmap::scene::Surface;
use whiskmap::texture::{TextureSample, histogram, shape, texture};
use whiskmap::whisk::{AngleCourse, WhiskEventKind};

/// Equal seeds give equal surfaces. Asperities stay in order, and apart.
#[test]
fn surfaces_are_reproducible() {
    let surface = scene("texture_cone").surface.unwrap();
    let places = surface.asperities_mm();
    assert_eq!(places, surface.asperities_mm());
    assert_ne!(places, Surface { seed: 1, ..surface }.asperities_mm());
    assert_eq!(places.len(), 321);
    let apart = places.windows(2).map(|pair| pair[1] - pair[0]);
    let least = apart.fold(f64::INFINITY, f64::min);
    let allowed = 1e-3 * surface.spacing_um * (1.0 - surface.jitter);
    assert!(least >= allowed && least < 1.2 * allowed, "{least}");
    let even = Surface { jitter: 0.0, ..surface }.asperities_mm();
    assert!((even[0] + 8.0).abs() < 1e-12 && (even[320] - 8.0).abs() < 1e-12 && even[160] == 0.0);
}

/// The shape of a sample ends at its tip, and touches its asperity.
#[test]
fn shapes_end_at_the_tip() {
    for name in SHIPPED {
        let scene = scene(name);
        let surface = scene.surface.unwrap();
        let sweep = AngleCourse::sine(15.0, 0.2, 5.0, 10.0).unwrap();
        let found = texture(&scene.whisker, &surface, &sweep).unwrap();
        let bent = |sample: &&TextureSample| sample.asperity.is_some();
        let mut sides = Vec::new();
        for sample in found.samples.iter().filter(bent).step_by(5).chain(&found.samples[..1]) {
            let points = shape(&scene.whisker, &surface, sample, 400).unwrap();
            let [x, y] = points[points.len() - 1];
            let tip =
                [sample.tip_x_mm.unwrap(), surface.distance_mm + sample.tip_height_mm.unwrap()];
            // Measured: 4.7e-12 mm, the difference of two resolutions.
            assert!((x - tip[0]).hypot(y - tip[1]) < 5e-11, "{name} {x} {y} {tip:?}");
            // Measured: 2.5e-13 mm at the base, 1.8e-13 mm at the contact.
            assert!(points[0][0].hypot(points[0][1]) < 5e-12);
            if let Some(asperity) = sample.asperity {
                let centre = [surface.asperities_mm()[asperity], surface.distance_mm];
                let away = points.iter().map(|[x, y]| (x - centre[0]).hypot(y - centre[1]));
                let nearest = away.fold(f64::INFINITY, f64::min);
                assert!(
                    (nearest - 1e-3 * surface.asperity_radius_um).abs() < 5e-12,
                    "{name} {nearest}"
                );
                sides.push(sample.side.unwrap());
            }
        }
        assert!(Side::BOTH.iter().all(|side| sides.contains(side)), "{name}");
    }
}

/// Histograms keep all weights, and the largest value lies in the last bin.
#[test]
fn histograms_keep_all_weights() {
    let bins = histogram(&[[0.0, 1.0], [0.5, 2.0], [1.0, 4.0]], None, 4);
    let wanted = [([0.0, 0.25], 1.0), ([0.25, 0.5], 0.0), ([0.5, 0.75], 2.0), ([0.75, 1.0], 4.0)];
    assert_eq!(bins, wanted);
    assert_eq!(histogram(&[[2.0, 1.0], [2.0, 1.0]], None, 4), [([2.0, 2.0], 2.0)]);
    assert_eq!(histogram(&[], None, 4), []);
    let from_0 = [([0.0, 1.0], 0.0), ([1.0, 2.0], 5.0)];
    assert_eq!(histogram(&[[2.0, 5.0]], Some(0.0), 2), from_0);
    let found = texture(
        &scene("texture_cone").whisker,
        &scene("texture_cone").surface.unwrap(),
        &AngleCourse::sine(15.0, 0.2, 5.0, 50.0).unwrap(),
    )
    .unwrap();
    let all: f64 = found.tip_histogram().iter().map(|bin| bin.tip_time_s).sum();
    // Measured: 1.8e-15 s.
    assert!((all - 5.0).abs() < 1e-13, "{all}");
    let stays = found.stays();
    let touches = found.events.iter().filter(|event| event.event == WhiskEventKind::Touch);
    assert_eq!(stays.len(), touches.count());
    let held: f64 = stays.iter().map(|stay| stay.dwell_s.unwrap_or(5.0 - stay.begin_s)).sum();
    assert!(held > 4.5 && held < 5.0, "{held}");
}
