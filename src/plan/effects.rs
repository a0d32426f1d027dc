//! The effects by name: which are on, and which line of the scene decides it. The only list of them.

use crate::rod::Effects;
use crate::scene::{Scene, Setup, Whisker};

/// An effect of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Effect {
    /// What people call it.
    pub name: &'static str,
    /// Whether it changes anything in this scene.
    pub on: bool,
    /// The keys of the scene that decide it, with their values.
    pub why: String,
    /// What it costs in the integration loop when it is on.
    pub cost: Cost,
}

/// What an effect costs in the integration loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Work at every step: sets of such effects have kernels of their own.
    Kernel,
    /// Nothing: it only changes where a trajectory starts.
    Start,
    /// Nothing: it is a faster taper.
    Taper,
}

/// Every effect; `kernels` are those that the kernels of the run have.
#[must_use]
pub fn effects(scene: &Scene, kernels: Effects) -> Vec<Effect> {
    let Setup { whisker, pole, .. } = &**scene;
    let stretch = given("arc_stretch", whisker.arc_stretch, 1.0);
    let stretched = whisker.arc_stretch != 1.0;
    let tapers = kernels.taper || kernels.profile;
    vec![
        Effect {
            name: "taper",
            on: kernels.taper && !kernels.profile,
            why: match (&scene.grid.taper, &whisker.profile) {
                (_, Some(_)) => "the radii are measured".to_owned(),
                (Some(axis), None) => swept("grid.taper", axis),
                (None, None) => radii(whisker),
            },
            cost: Cost::Kernel,
        },
        Effect {
            name: "measured radii",
            on: kernels.profile,
            why: match &whisker.profile {
                Some(rows) => format!("{} rows of whisker.profile", rows.len()),
                None => "no whisker.profile".to_owned(),
            },
            cost: Cost::Kernel,
        },
        Effect {
            name: "curvature",
            on: kernels.curvature,
            why: match &scene.grid.curvature_per_mm {
                Some(axis) => swept("grid.curvature_per_mm", axis),
                None => {
                    let own = whisker.curvature.map_or(0.0, |own| own.parabola_per_mm);
                    given("parabola_per_mm", own, 0.0)
                }
            },
            cost: Cost::Kernel,
        },
        Effect {
            name: "euler spiral",
            on: kernels.spiral,
            why: match whisker.euler_spiral {
                Some(own) => format!("per_mm {}, per_mm2 {}", own.per_mm, own.per_mm2),
                None => "euler_spiral is 0 or left out".to_owned(),
            },
            cost: Cost::Kernel,
        },
        Effect {
            name: "modulus gradient",
            on: kernels.gradient,
            why: given("tip_to_base", whisker.modulus_tip_to_base, 1.0),
            cost: Cost::Kernel,
        },
        Effect {
            name: "pole radius",
            on: pole.radius_mm != 0.0,
            why: given("radius_mm", pole.radius_mm, 0.0),
            cost: Cost::Start,
        },
        Effect {
            name: "friction",
            on: pole.friction != 0.0,
            why: given("friction", pole.friction, 0.0),
            cost: Cost::Start,
        },
        Effect {
            name: "projection",
            on: stretched && tapers,
            why: if stretched && !tapers {
                format!("{stretch} does nothing without taper")
            } else {
                stretch
            },
            cost: Cost::Taper,
        },
    ]
}

/// A key that changes nothing at `neutral`, which is also what leaving it out means.
fn given(key: &str, value: f64, neutral: f64) -> String {
    if value == neutral {
        format!("{key} is {neutral} or left out")
    } else {
        format!("{key} {value}")
    }
}

/// An axis that stands in for the whisker's own value.
fn swept(key: &str, axis: &[f64]) -> String {
    match axis {
        [first, .., last] => format!("{key} {first} to {last}"),
        _ => axis
            .iter()
            .fold(key.to_owned(), |key, x| format!("{key} {x}")),
    }
}

fn radii(whisker: &Whisker) -> String {
    let Whisker {
        base_radius_um: base,
        tip_radius_um: tip,
        ..
    } = whisker;
    let relation = if tip < base { "<" } else { "=" };
    format!("tip_radius_um {tip} {relation} base_radius_um {base}")
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::plan::Plan;

    /// Every effect as `+name: why` or `-name: why`; `more` are lines after those of a straight cylinder.
    fn listed(tip_radius_um: f64, more: &str) -> Vec<String> {
        let text = format!(
            "title = \"t\"\ngrid.push_angle_deg = [1, 2]\ngrid.distance_mm = [5]\n\
             whisker.length_mm = 20\nwhisker.base_radius_um = 30\nwhisker.tip_radius_um = {tip_radius_um}\n\
             whisker.youngs_modulus_gpa = 3\n{more}"
        );
        let scene = Scene::parse(&text, "scene").unwrap();
        let plan = Plan::new(&scene).unwrap();
        let sign = |on| if on { '+' } else { '-' };
        effects(&scene, plan.method.effects)
            .iter()
            .map(|e| format!("{}{}: {}", sign(e.on), e.name, e.why))
            .collect()
    }

    #[test]
    fn nothing_is_on_that_no_line_asks_for() {
        let neutral = "whisker.curvature.parabola_per_mm = 0\nwhisker.modulus_gradient.tip_to_base = 1\n\
                       whisker.projection.arc_stretch = 1\npole.radius_mm = 0\ncontact.friction = 0\n";
        for more in ["", neutral] {
            let expected = [
                "-taper: tip_radius_um 30 = base_radius_um 30",
                "-measured radii: no whisker.profile",
                "-curvature: parabola_per_mm is 0 or left out",
                "-euler spiral: euler_spiral is 0 or left out",
                "-modulus gradient: tip_to_base is 1 or left out",
                "-pole radius: radius_mm is 0 or left out",
                "-friction: friction is 0 or left out",
                "-projection: arc_stretch is 1 or left out",
            ];
            assert_eq!(listed(30.0, more), expected);
        }
    }

    #[test]
    fn every_line_turns_its_own_effect_on() {
        let lines = [
            (
                "whisker.curvature.parabola_per_mm = 0.02",
                2,
                "parabola_per_mm 0.02",
            ),
            (
                "whisker.curvature.euler_spiral = { per_mm = 0.02, per_mm2 = -0.001 }",
                3,
                "per_mm 0.02, per_mm2 -0.001",
            ),
            (
                "whisker.modulus_gradient.tip_to_base = 1.5",
                4,
                "tip_to_base 1.5",
            ),
            ("pole.radius_mm = 0.25", 5, "radius_mm 0.25"),
            ("contact.friction = 0.2", 6, "friction 0.2"),
            (
                "whisker.projection.arc_stretch = 1.03",
                7,
                "arc_stretch 1.03",
            ),
        ];
        let bare = listed(1.5, "");
        assert_eq!(bare[0], "+taper: tip_radius_um 1.5 < base_radius_um 30");
        for (line, at, why) in lines {
            let mut expected = bare.clone();
            let name = bare[at][1..].split(':').next().unwrap();
            expected[at] = format!("+{name}: {why}");
            assert_eq!(listed(1.5, line), expected);
        }
    }

    #[test]
    fn axes_stand_in_for_the_whiskers_own_values() {
        let axis = |line| listed(1.5, line);
        assert_eq!(
            axis("grid.taper = [0, 0.5]")[0],
            "+taper: grid.taper 0 to 0.5"
        );
        assert_eq!(axis("grid.taper = [0]")[0], "-taper: grid.taper 0");
        let curvature = "+curvature: grid.curvature_per_mm 0 to 0.04";
        assert_eq!(
            axis("grid.curvature_per_mm = [0, 0.01, 0.04]")[2],
            curvature
        );
    }

    #[test]
    fn a_projected_cylinder_is_a_cylinder() {
        let projection = "-projection: arc_stretch 1.03 does nothing without taper";
        assert_eq!(
            listed(30.0, "whisker.projection.arc_stretch = 1.03")[7],
            projection
        );
    }
}
