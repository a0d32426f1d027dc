//! The shaders without a device: every text that the engine can build is valid, with every choice of planes and every set of effects.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use crate::effect_sets;
use naga::back::PipelineConstants;
use naga::back::pipeline_constants::process_overrides;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use whiskmap::engine::gpu::{Precision, shaders};
use whiskmap::plan::{Channels, STATE_CHANNELS};

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

/// Constants of a shader by name.
type Constants<const N: usize> = [(&'static str, f64); N];

/// The constants of every choice of planes: no channel of a state, each one alone, and all, without and with strains.
fn choices() -> Vec<Constants<2>> {
    let alone = STATE_CHANNELS.map(|channel| Channels::those(|name| name == channel));
    let none = Channels::those(|_| false);
    let all = alone.into_iter().chain([none, none.with_states()]);
    all.flat_map(|channels| [channels, channels.with("peak_strain")])
        .map(shaders::overrides)
        .collect()
}

/// Parses and validates `text`, for every entry point and with the values of its constants put in.
fn validate<const N: usize>(
    text: &str,
    precision: Precision,
    choices: &[Constants<N>],
) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|e| e.emit_to_string(text))?;
    let capabilities = match precision {
        Precision::F32 => Capabilities::empty(),
        _ => Capabilities::FLOAT64,
    };
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    let info = validator.validate(&module).map_err(|e| e.emit_to_string(text))?;
    for entry in &module.entry_points {
        for constants in choices {
            let named = constants.iter().map(|(name, value)| ((*name).to_owned(), *value));
            let constants: PipelineConstants = named.collect();
            let entry_point = Some((entry.stage, entry.name.as_str()));
            let (module, _) = process_overrides(&module, &info, entry_point, &constants)
                .map_err(|e| format!("{constants:?}: {e}"))?;
            let resolved = Validator::new(ValidationFlags::all(), capabilities).validate(&module);
            resolved.map_err(|e| format!("{constants:?}: {e:?}"))?;
        }
    }
    Ok(())
}

#[test]
fn every_text_is_valid() {
    for precision in PRECISIONS {
        let sets: Vec<_> = effect_sets::all().map(shaders::effects).collect();
        validate(&shaders::shoot(precision), precision, &sets).unwrap_or_else(|e| panic!("{e}"));
        validate(&shaders::cells(precision), precision, &choices())
            .unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn a_broken_text_is_refused() {
    let text = shaders::cells(Precision::F32);
    for (good, bad) in
        [("cell.point = state.yz", "cell.point = state.xyz"), ("override HAS_POINTS: bool;", "")]
    {
        assert!(text.contains(good));
        assert!(validate(&text.replace(good, bad), Precision::F32, &choices()).is_err());
    }
    // Double precision is a capability.
    assert!(validate(&shaders::cells(Precision::F64), Precision::F32, &choices()).is_err());
}
