//! The shaders without a device: every text that the engine can build is valid, with every set of effects that it has.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use crate::effect_sets;

use naga::back::PipelineConstants;
use naga::back::pipeline_constants::process_overrides;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use whiskmap::engine::gpu::{Precision, shaders};
use whiskmap::rod::Effects;

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

/// Parses and validates `text`, for every entry point and with the values of its constants put in.
fn validate(text: &str, precision: Precision, effects: &[Effects]) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|e| e.emit_to_string(text))?;
    let capabilities = match precision {
        Precision::F32 => Capabilities::empty(),
        _ => Capabilities::FLOAT64,
    };
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    let info = validator
        .validate(&module)
        .map_err(|e| e.emit_to_string(text))?;
    for entry in &module.entry_points {
        for effects in effects {
            let constants: PipelineConstants = shaders::overrides(*effects)
                .map(|(name, value)| (name.to_owned(), value))
                .into_iter()
                .collect();
            let entry_point = Some((entry.stage, entry.name.as_str()));
            let (module, _) = process_overrides(&module, &info, entry_point, &constants)
                .map_err(|e| format!("{effects:?}: {e}"))?;
            let resolved = Validator::new(ValidationFlags::all(), capabilities).validate(&module);
            resolved.map_err(|e| format!("{effects:?}: {e:?}"))?;
        }
    }
    Ok(())
}

#[test]
fn every_text_is_valid() {
    for precision in PRECISIONS {
        let sets: Vec<Effects> = effect_sets::on_gpu().collect();
        for (text, sets) in [
            (shaders::cells(precision), &sets[..]),
            (shaders::peak(precision), &[]),
        ] {
            validate(&text, precision, sets).unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

#[test]
fn a_broken_text_is_refused() {
    let none = [Effects::default()];
    let text = shaders::cells(Precision::F32);
    for (good, bad) in [
        ("= base_point[POSITIONS].xy", "= base_point[POSITIONS].xyz"),
        ("override TAPER: bool;", ""),
    ] {
        assert!(text.contains(good));
        assert!(validate(&text.replace(good, bad), Precision::F32, &none).is_err());
    }
    // Double precision is a capability.
    let text = shaders::cells(Precision::F64);
    assert!(validate(&text, Precision::F32, &none).is_err());
}
