//! Files of other versions.

use super::{Place, SCENE};

/// Channels of an incompatible version may have other meanings.
#[test]
fn render_warns_of_another_version() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let current = env!("CARGO_PKG_VERSION");
    let render = |version: &str| {
        let written = format!("\"{version}\"");
        let mut bytes = place.bytes("outputs/scene.exr");
        let known = format!("\"{current}\"");
        for at in 0..=bytes.len() - known.len() {
            if bytes[at..].starts_with(known.as_bytes()) {
                bytes[at..at + known.len()].copy_from_slice(written.as_bytes());
            }
        }
        super::sealed::seal(&mut bytes);
        std::fs::write(place.path("old.exr"), bytes).unwrap();
        let run = place.good(&["render", "old.exr"]);
        run.err
    };
    let patch = current.rfind('.').unwrap() + 1;
    assert_eq!(render(current), "");
    assert_eq!(render(&format!("{}9", &current[..patch])), "");
    let other = format!("9{}", &current[1..]);
    let warning = format!("warning: old.exr was written by whiskmap {other}, not by {current}");
    let said = render(&other);
    assert!(said.starts_with(&warning) && said.lines().count() == 1, "{said}");
}
