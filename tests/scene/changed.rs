//! Scenes with other values, by key and by parameter.

use std::collections::HashSet;
use whiskmap::scene::{AxisScale, AxisValues, Parameter, Scene, SceneBuilder, SceneData};

use super::{BASE, parse, sweep};
use crate::shipped;

fn cone() -> Scene {
    Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml").unwrap()
}

#[test]
fn a_changed_scene_is_checked_like_its_file() {
    let base = parse(BASE).unwrap();
    let rough = base.with(Parameter::Friction, 0.4).unwrap();
    assert_eq!(rough.pole.friction, 0.4);
    assert_eq!((&rough.whisker, &rough.grid, &rough.name), (&base.whisker, &base.grid, &base.name));
    let exact = [0.1 + 0.2, 1e-7_f64.mul_add(1.0, 17.0)];
    let listed = base.to_builder().distance_mm(exact).build().unwrap();
    assert_eq!(listed.grid.distance_mm, exact);
    let why = |builder: SceneBuilder| builder.build().unwrap_err().to_string();
    for (builder, said) in [
        (
            base.to_builder().distance_mm([5.0, 2.0]),
            "error: grid.distance_mm[1] = 2: must be greater than the value before it (5)",
        ),
        (
            base.to_builder().set(Parameter::LengthMm, f64::NAN),
            "error: whisker.length_mm = NaN: must be between 0.001 and 100000",
        ),
        (
            base.to_builder().push_angle_deg(AxisValues::linear(5.0, 1.0, 3)),
            "error: grid.push_angle_deg.to = 1: must be greater than from (5)",
        ),
        (
            base.to_builder().set(Parameter::SpiralPerMm, 0.1),
            "error: grid.curvature_per_mm: must be left out: the whisker is an Euler spiral",
        ),
        (
            cone().to_builder().set(Parameter::SpiralPerMm, 0.1),
            "error: whisker.curvature: must have either parabola_per_mm",
        ),
        (
            base.to_builder().sweep(Parameter::YoungsModulusGpa, [1.0]),
            "error: grid.youngs_modulus_gpa: must be left out: no axis varies it",
        ),
        (Scene::builder("empty"), "error: whisker.length_mm: is left out"),
        (
            base.to_builder().set(Parameter::Taper, 1.5),
            "error: taper = 1.5: must be between 0 and 1",
        ),
        (base.to_builder().title("two\nlines"), "error: title: must be one line of text"),
    ] {
        let why = why(builder);
        assert!(why.starts_with(said), "{why}");
    }
}

/// Every scene as text is read back: the shipped ones, and those with a number of every kind.
#[test]
fn a_scene_survives_its_own_text() {
    let all = "[whisker.modulus_gradient]\ntip_to_base = 1.3\n[contact]\nfriction = 0.1\n\
               [uncertainty]\ntaper = 0.01\nlength_mm = 0.3\n";
    let full = parse(&format!("{}{all}", sweep())).unwrap_err();
    assert!(full.contains("does not give whisker.tip_radius_um"), "{full}");
    let full = parse(&format!("{BASE}{all}")).unwrap();
    let shipped = shipped::scenes().into_iter();
    for scene in shipped.chain([full, parse(&sweep()).unwrap()]) {
        // The same numbers without the source text.
        let built = scene.to_builder().build().unwrap();
        let again = Scene::parse(&built.to_toml(), &format!("{}.toml", built.name)).unwrap();
        assert_eq!(*again, *built, "{}", built.to_toml());
        let data = SceneData { text: built.text.clone(), ..SceneData::clone(&scene) };
        assert_eq!(data, *built);
    }
    let log = AxisValues::Range { from: 1e-7, to: Some(0.2), count: 7, scale: AxisScale::Log };
    let rough = cone().to_builder().sweep(Parameter::Friction, log);
    let rough = rough.build().unwrap();
    assert_eq!(parse(&rough.to_toml()).unwrap().grid, rough.grid);
}

#[test]
fn parameters_are_read_and_replaced() {
    let scene = cone();
    for parameter in Parameter::ALL {
        let Some(current) = parameter.value(&scene) else {
            continue;
        };
        let same = scene.with(parameter, current).unwrap();
        assert_eq!(parameter.value(&same), Some(current), "{}", parameter.name());
        let [least, most] = parameter.range(&scene);
        assert!(least <= current && current <= most, "{}", parameter.name());
        let accepts = |value| scene.with(parameter, value).is_ok();
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

/// Neutral values of all parameters, in scenes that leave them out: shipped ones, and one without a curvature.
#[test]
fn neutral_values_change_nothing() {
    let scenes = shipped::scenes().into_iter();
    let straight = Scene::builder("straight")
        .set(Parameter::LengthMm, 20.0)
        .set(Parameter::BaseRadiusUm, 30.0)
        .set(Parameter::TipRadiusUm, 3.0)
        .set(Parameter::YoungsModulusGpa, 3.0)
        .push_angle_deg([1.0])
        .distance_mm([5.0]);
    let scenes = scenes.chain([straight.build().unwrap()]);
    let mut seen = HashSet::new();
    for scene in scenes.filter(|scene| !scene.is_sweep()) {
        for parameter in Parameter::ALL {
            if parameter.value(&scene).is_none()
                && let Some(value) = parameter.neutral()
                && let Ok(other) = scene.with(parameter, value)
            {
                let both = [&scene, &other].map(|scene| (&scene.whisker, scene.pole));
                assert_eq!(both[0], both[1], "{}", parameter.name());
                seen.insert(parameter);
            }
        }
    }
    let neutral = Parameter::ALL.into_iter();
    let neutral = neutral.filter(|parameter| parameter.neutral().is_some());
    assert_eq!(seen, neutral.collect());
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
fn rewritten_text_keeps_the_comments() {
    let scene = cone();
    let values = [(Parameter::TipRadiusUm, 4.0), (Parameter::Friction, 0.25)];
    let text = scene.to_toml_with(&values).unwrap();
    let rough = scene.with_parameters(&values).unwrap();
    assert_eq!(rough.pole.friction, 0.25);
    let read = Scene::parse(&text, "cone.toml").unwrap();
    assert_eq!((&read.whisker, read.pole), (&rough.whisker, rough.pole));
    let expected = scene.to_toml().replace("tip_radius_um = 1.5 ", "tip_radius_um = 4.0 ");
    assert!(text.starts_with(&expected), "{text}");
    let tapered = scene.to_toml_with(&[(Parameter::Taper, 0.5)]).unwrap();
    assert!(tapered.contains("tip_radius_um = 15.0 "), "{tapered}");
    // 30 (1 - 0.7) is 9.000000000000002.
    let tapered = scene.to_toml_with(&[(Parameter::Taper, 0.7)]).unwrap();
    assert!(tapered.contains("tip_radius_um = 9.0 "), "{tapered}");
    assert!(scene.to_toml_with(&[(Parameter::Taper, 1.5)]).is_err());
}
