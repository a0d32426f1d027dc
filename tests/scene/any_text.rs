//! No text and no bytes make a scene panic, and what is accepted keeps its promises.

use std::fs;

use proptest::prelude::*;
use whiskmap::scene::Scene;

use super::{parse, shipped, with_line};

proptest! {
    #[test]
    fn an_even_axis_has_both_ends_exactly(from in -360.0..360.0, width in 1e-6..300.0, count in 2..2000_usize) {
        let to = f64::min(from + width, 360.0);
        prop_assume!(to - from > 1e-7);
        let axis = format!("push_angle_deg = {{ from = {from:?}, to = {to:?}, count = {count} }}");
        let values = parse(&with_line(13, &axis)).unwrap().grid.push_angle_deg.clone();
        prop_assert_eq!(values.len(), count);
        prop_assert_eq!(values[0], from);
        prop_assert_eq!(values[count - 1], to);
        let step: f64 = (to - from) / (count - 1) as f64;
        prop_assert!(values.windows(2).all(|pair| f64::abs(pair[1] - pair[0] - step) < 1e-12));
    }

    #[test]
    fn no_text_panics(text in ".*") {
        let _ = parse(&text);
    }

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), bytes).unwrap();
        let _ = Scene::read(file.path()).map_err(|why| why.to_string());
    }
}

/// What a mutation puts somewhere into a scene.
const SHARDS: [&str; 24] = [
    "nan",
    "-inf",
    "1e308",
    "-0.0",
    "1e-320",
    "0",
    "-1",
    "9223372036854775807",
    "1e18",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "\"\"\"",
    "=",
    ".",
    ",",
    "\n",
    "\r",
    "\0",
    "µ",
    "\u{feff}",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_mutated_scene_panics(
        which in any::<prop::sample::Index>(),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0..12_usize, prop::sample::select(&SHARDS[..])), 1..4),
    ) {
        let mut chars: Vec<char> = fs::read_to_string(which.get(&shipped::scene_paths())).unwrap().chars().collect();
        for (place, length, shard) in cuts {
            let start = place.index(chars.len());
            let end = usize::min(start + length, chars.len());
            chars.splice(start..end, shard.chars());
        }
        let text: String = chars.into_iter().collect();
        match Scene::parse(&text, "test.toml") {
            Ok(scene) => {
                let axes = [Some(&scene.grid.push_angle_deg), Some(&scene.grid.distance_mm), scene.grid.sweep.first().map(|axis| &axis.values)];
                for axis in axes.into_iter().flatten() {
                    prop_assert!(!axis.is_empty() && axis.iter().all(|x| x.is_finite()));
                    prop_assert!(axis.is_sorted_by(|a, b| a < b));
                }
                for whisker in scene.whiskers().flatten().map(|swept| swept.whisker) {
                    prop_assert!((0.0..=whisker.base_radius_um).contains(&whisker.tip_radius_um));
                }
            }
            Err(why) => {
                prop_assert!(why.render(false).starts_with("error: "));
                prop_assert!(why.render(true).contains("test.toml"));
            }
        }
    }
}
