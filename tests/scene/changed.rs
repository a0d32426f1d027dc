//! Scenes with other values, by key and by parameter.

use whiskmap::scene::{Parameter, Scene};

use crate::{BASE, parse};

fn cone() -> Scene {
    Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml").unwrap()
}

#[test]
fn a_changed_scene_is_checked_like_its_file() {
    let base = parse(BASE).unwrap();
    let rough = base.with("contact.friction", 0.4).unwrap();
    assert_eq!(rough.pole.friction, 0.4);
    assert_eq!(
        (&rough.whisker, &rough.grid, &rough.name),
        (&base.whisker, &base.grid, &base.name)
    );
    assert_eq!(parse(&rough.text).unwrap(), rough);
    let exact = [0.1 + 0.2, 1e-7_f64.mul_add(1.0, 17.0)];
    assert_eq!(
        base.with("grid.distance_mm", exact)
            .unwrap()
            .grid
            .distance_mm,
        exact
    );
    for (key, value, said) in [
        (
            "grid.distance_mm",
            vec![5.0, 2.0],
            "grid.distance_mm[1] = 2.0: must be greater",
        ),
        ("pole.radius_mm", vec![1.0], "expected a number"),
        (
            "pole.radius_mm.more",
            vec![1.0],
            "radius_mm is a value, not a table",
        ),
        ("pole.colour", vec![1.0], "unknown field `colour`"),
    ] {
        let why = base.with(key, value).unwrap_err().to_string();
        assert!(why.contains(said), "{why}");
    }
}

#[test]
fn parameters_are_read_and_replaced() {
    let scene = cone();
    for parameter in Parameter::ALL {
        let Some(own) = parameter.value(&scene) else {
            continue;
        };
        let same = scene.with_parameters(&[(parameter, own)]).unwrap();
        assert_eq!(parameter.value(&same), Some(own), "{}", parameter.name());
        let [least, most] = parameter.range(&scene);
        assert!(least <= own && own <= most, "{}", parameter.name());
        let accepts = |value| scene.with_parameters(&[(parameter, value)]).is_ok();
        assert_eq!(
            [least.next_down(), least, most, most.next_up()].map(accepts),
            [false, true, true, false],
            "{} from {least} to {most}",
            parameter.name()
        );
    }
    let given = Parameter::ALL.map(|parameter| parameter.value(&scene).is_some());
    assert_eq!(given.iter().filter(|given| **given).count(), 8);
}

#[test]
fn a_taper_is_that_of_the_new_base() {
    let scene = cone();
    let pairs = [(Parameter::Taper, 0.5), (Parameter::BaseRadiusUm, 40.0)];
    for pairs in [pairs, [pairs[1], pairs[0]]] {
        let other = scene.with_parameters(&pairs).unwrap();
        assert_eq!(other.whisker.tip_radius_um, 20.0);
    }
}

#[test]
fn other_values_keep_the_comments() {
    let scene = cone();
    let other = scene
        .with_parameters(&[(Parameter::TipRadiusUm, 4.0), (Parameter::Friction, 0.25)])
        .unwrap();
    assert_eq!(other.pole.friction, 0.25);
    let expected = scene
        .text
        .replace("tip_radius_um = 1.5 ", "tip_radius_um = 4.0 ");
    assert!(other.text.starts_with(&expected), "{}", other.text);
}
