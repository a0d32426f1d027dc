//! Courses that the model does not determine, or refuses.

use super::{SINGLE, course, scene};
use whiskmap::scene::{Parameter, Scene, Surface};
use whiskmap::texture::{
    NoTextureState, TextureError, TexturePhase, TextureSample, shape, texture,
};
use whiskmap::traced::TracedShape;
use whiskmap::whisk::WhiskEventKind;

/// Courses that the model does not determine end there, with the reason.
#[test]
fn what_the_model_does_not_determine_has_a_reason() {
    let hair = scene("texture_hair");
    // Beside its base a hair bends by more than a right angle: its free part comes down onto the surface behind the contact.
    let near = Surface { distance_mm: 6.0, spacing_um: 12_000.0, length_mm: 12.0, ..SINGLE };
    let angles: Vec<f64> = (-60..=60).map(f64::from).collect();
    let found = texture(&hair.whisker, &near, &course(&angles)).unwrap();
    let first = found.samples.iter().position(|sample| sample.reason.is_some()).unwrap();
    assert!(found.samples[..first].iter().all(|sample| sample.energy_nj.is_some()));
    for sample in &found.samples[first..] {
        assert_eq!(sample.phase, TexturePhase::Undecided);
        assert_eq!(sample.reason, Some(NoTextureState::CrossesSurface));
        assert_eq!((sample.asperity, sample.force_un, sample.tip_x_mm), (None, None, None));
        assert_eq!(shape(&hair.whisker, &near, sample, 9).unwrap(), Vec::<[f64; 2]>::new());
    }
    let last = found.events.last().unwrap();
    assert_eq!((last.event, last.time_s), (WhiskEventKind::Undecided, found.samples[first].time_s));
    let stays = found.stays();
    assert_eq!(stays.last().unwrap().end, Some(WhiskEventKind::Undecided));
    // Next to the tip a push ends before the resting whisker is clear of the asperity, as in `whisk`.
    let cone = scene("texture_cone");
    let thick = Surface { distance_mm: 16.18, asperity_radius_um: 100.0, ..SINGLE };
    let found = texture(&cone.whisker, &thick, &course(&[-1.0, 0.35, 1.0])).unwrap();
    let reasons: Vec<_> = found.samples.iter().map(|sample| sample.reason).collect();
    assert_eq!(reasons, [None, Some(NoTextureState::OnAnAsperity), None]);
    // The energy of the undecided state is not known, and neither is that which the detachment loses.
    assert!(found.lost_nj().is_nan());
}

/// Points of a whisker that rises, runs beside the surface and rises again: `[point][x, y]` in mm.
fn stepped_points() -> Vec<[f64; 2]> {
    let ramp = |from: f64, to: f64, s: f64| {
        let x = ((s - from) / (to - from)).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    };
    let angle =
        |s: f64| (85.0 - 103.0 * ramp(3.0, 10.0, s) + 88.0 * ramp(12.0, 18.0, s)).to_radians();
    let mut at = [0.0; 2];
    let steps = (0..200).map(|i| {
        let (sin, cos) = angle(0.1 * (f64::from(i) + 0.5)).sin_cos();
        at = [at[0] + 0.1 * cos, at[1] + 0.1 * sin];
        at
    });
    std::iter::once([0.0; 2]).chain(steps).collect()
}

/// A part between contact and tip comes down onto the surface, although the tip is above it.
#[test]
fn the_whole_free_part_stays_above_the_contact() {
    let scene = Scene::builder("A whisker with a step")
        .set(Parameter::BaseRadiusUm, 30.0)
        .set(Parameter::TipRadiusUm, 3.0)
        .set(Parameter::YoungsModulusGpa, 3.0)
        .traced(TracedShape::fit(stepped_points(), Some(6)).unwrap())
        .push_angle_deg([1.0])
        .distance_mm([5.0])
        .build()
        .unwrap();
    let whisker = &scene.whisker;
    let surface = Surface { distance_mm: 6.3, ..SINGLE };
    let angles: Vec<f64> = (0..=350).map(|i| 50.0 - 0.2 * f64::from(i)).collect();
    let found = texture(whisker, &surface, &course(&angles)).unwrap();
    // Height of the lowest point from 3 mm beyond the contact on, above the contact.
    let margin = |sample: &TextureSample| {
        let points = shape(whisker, &surface, sample, 2001).unwrap();
        let part = |s_mm: f64| (s_mm / whisker.length_mm * 2000.0) as usize;
        let contact_mm = sample.arc_length_mm.unwrap();
        // The contact is one more point.
        let [_, contact] = points[part(contact_mm) + 1];
        let free = points[part(contact_mm + 3.0)..].iter().map(|[_, y]| *y);
        free.fold(f64::INFINITY, f64::min) - contact
    };
    let crossed = found.samples.iter().position(|sample| sample.reason.is_some());
    let (held, undecided) = found.samples.split_at(crossed.unwrap());
    for sample in undecided {
        assert_eq!(sample.reason, Some(NoTextureState::CrossesSurface));
    }
    let held: Vec<_> = held.iter().filter(|sample| sample.asperity.is_some()).collect();
    let margins: Vec<f64> = held.iter().map(|sample| margin(sample)).collect();
    assert!(margins.is_sorted_by(|one, next| one > next) && margins.len() > 10);
    let [.., before, last] = margins[..] else { panic!("{margins:?}") };
    // The course ends between the last sample above the line and the next one, with the tip far above it.
    assert!(last > 0.0 && last + (last - before) < 0.0, "{before} {last}");
    assert!(held.last().unwrap().tip_height_mm > Some(4.0));
}

#[test]
fn courses_that_cannot_be_are_refused() {
    let cone = scene("texture_cone");
    let surface = cone.surface.unwrap();
    let refused = |surface: &Surface, angles: &[f64]| {
        texture(&cone.whisker, surface, &course(angles)).unwrap_err()
    };
    assert_eq!(refused(&surface, &[0.0, 91.0]), TextureError::Angle { index: 1, angle_deg: 91.0 });
    let thick = Surface { asperity_radius_um: 400.0, ..SINGLE };
    let why = refused(&thick, &[-2.0, 1.0]);
    let TextureError::Begin { touches_deg: [cb, cf], asperity: 0, .. } = why else {
        panic!("{why}");
    };
    // Both touches are accepted as they are.
    for touch in [cb, cf] {
        assert!(texture(&cone.whisker, &thick, &course(&[touch, touch + 1.0])).is_ok());
    }
    // The numbers of a surface are checked when it is used.
    let endless = Surface { spacing_um: 0.0, ..SINGLE };
    let why = refused(&endless, &[0.0, 1.0]).to_string();
    assert!(why.contains("surface.spacing_um = 0: must be"), "{why}");
    // Far from the middle the whisker meets the line at a slant, and does not fit between asperities.
    let dense = Surface { spacing_um: 101.0, distance_mm: 6.0, length_mm: 20.0, ..SINGLE };
    let why = refused(&dense, &[0.0, 1.0]);
    assert!(matches!(why, TextureError::Blocked { .. }), "{why}");
}
