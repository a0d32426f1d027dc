//! Files of other versions.

use super::{Place, SCENE};

/// Channels of an incompatible version may have other meanings.
#[test]
fn render_warns_of_another_version() {
    let place = Place::with(SCENE);
    place.map(&["scene.toml", "--no-png"]);
    let own = env!("CARGO_PKG_VERSION");
    let render = |version: &str| {
        let written = format!("\"{version}\"");
        let mut bytes = place.bytes("outputs/scene.exr");
        let own = format!("\"{own}\"");
        for at in 0..=bytes.len() - own.len() {
            if bytes[at..].starts_with(own.as_bytes()) {
                bytes[at..at + own.len()].copy_from_slice(written.as_bytes());
            }
        }
        super::sealed::seal(&mut bytes);
        std::fs::write(place.path("old.exr"), bytes).unwrap();
        let run = place.run(&["render", "old.exr"]);
        assert_eq!(run.code, Some(0), "{run:?}");
        run.err
    };
    let patch = own.rfind('.').unwrap() + 1;
    assert_eq!(render(own), "");
    assert_eq!(render(&format!("{}9", &own[..patch])), "");
    let other = format!("9{}", &own[1..]);
    let warning = format!("warning: old.exr was written by whiskmap {other}, not by {own}");
    let said = render(&other);
    assert!(
        said.starts_with(&warning) && said.lines().count() == 1,
        "{said}"
    );
}
