//! Courses that the model does not determine, or refuses.

use super::{SINGLE, course, scene};
use whiskmap::scene::Surface;
use whiskmap::texture::{NoTextureState, TextureError, TexturePhase, shape, texture};
use whiskmap::whisk::WhiskEventKind;

/// Courses that the model does not determine end there, with the reason.
#[test]
fn what_the_model_does_not_determine_has_a_reason() {
    let hair = scene("texture_hair");
    // Beside its base a hair bends by more than a right angle: its free part comes down onto the surface behind the contact.
    let near = Surface {
        distance_mm: 6.0,
        spacing_um: 12_000.0,
        length_mm: 12.0,
        ..SINGLE
    };
    let angles: Vec<f64> = (-60..=60).map(f64::from).collect();
    let found = texture(&hair.whisker, &near, &course(&angles)).unwrap();
    let first = found
        .samples
        .iter()
        .position(|own| own.reason.is_some())
        .unwrap();
    assert!(
        found.samples[..first]
            .iter()
            .all(|own| own.energy_nj.is_some())
    );
    for sample in &found.samples[first..] {
        assert_eq!(sample.phase, TexturePhase::Undecided);
        assert_eq!(sample.reason, Some(NoTextureState::CrossesSurface));
        assert_eq!(
            (sample.asperity, sample.force_un, sample.tip_x_mm),
            (None, None, None)
        );
        assert_eq!(
            shape(&hair.whisker, &near, sample, 9).unwrap(),
            Vec::<[f64; 2]>::new()
        );
    }
    let last = found.events.last().unwrap();
    assert_eq!(
        (last.event, last.time_s),
        (WhiskEventKind::Undecided, found.samples[first].time_s)
    );
    let stays = found.stays();
    assert_eq!(stays.last().unwrap().end, Some(WhiskEventKind::Undecided));
    // Next to the tip a push ends before the resting whisker is clear of the asperity, as in `whisk`.
    let cone = scene("texture_cone");
    let thick = Surface {
        distance_mm: 16.18,
        asperity_radius_um: 100.0,
        ..SINGLE
    };
    let found = texture(&cone.whisker, &thick, &course(&[-1.0, 0.35, 1.0])).unwrap();
    let reasons: Vec<_> = found.samples.iter().map(|own| own.reason).collect();
    assert_eq!(reasons, [None, Some(NoTextureState::OnAnAsperity), None]);
    // The energy of the undecided state is not known, and neither is that which the detachment loses.
    assert!(found.lost_nj().is_nan());
}

#[test]
fn courses_that_cannot_be_are_refused() {
    let cone = scene("texture_cone");
    let surface = cone.surface.unwrap();
    let refused = |surface: &Surface, angles: &[f64]| {
        texture(&cone.whisker, surface, &course(angles)).unwrap_err()
    };
    assert_eq!(refused(&surface, &[0.0, 91.0]), TextureError::Angle(91.0));
    let thick = Surface {
        asperity_radius_um: 400.0,
        ..SINGLE
    };
    let why = refused(&thick, &[-2.0, 1.0]);
    let TextureError::Begin {
        touches_deg: [cb, cf],
        asperity: 0,
        ..
    } = why
    else {
        panic!("{why}");
    };
    // Both touches are accepted as they are.
    for touch in [cb, cf] {
        assert!(texture(&cone.whisker, &thick, &course(&[touch, touch + 1.0])).is_ok());
    }
    // The numbers of a surface are checked when it is used.
    let endless = Surface {
        spacing_um: 0.0,
        ..SINGLE
    };
    let why = refused(&endless, &[0.0, 1.0]).to_string();
    assert!(why.contains("surface.spacing_um = 0: must be"), "{why}");
    // Far from the middle the whisker meets the line at a slant, and does not fit between asperities.
    let dense = Surface {
        spacing_um: 101.0,
        distance_mm: 6.0,
        length_mm: 20.0,
        ..SINGLE
    };
    let why = refused(&dense, &[0.0, 1.0]);
    assert!(matches!(why, TextureError::Blocked { .. }), "{why}");
}
