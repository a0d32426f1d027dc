//! The values that make a whisker detach where it should: known ones come back, none is missed, none is made up.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use whiskmap::Side;
use whiskmap::design::{
    Design, DesignError, DesignGoal, DesignTarget, DesignVariable, DesignVaried, design,
    design_until, designs, designs_until, ends_between,
};
use whiskmap::scene::{Parameter, Scene};
use whiskmap::sensitivity::Variable;
use whiskmap::trace::{Branch, BranchPoint, Detachment, DetachmentKind, StableBranch, curve};

fn robot() -> Scene {
    Scene::parse(include_str!("../scenes/robot.toml"), "robot.toml").unwrap()
}

/// A scene that gives every number but a spiral's.
fn everything() -> Scene {
    let text = "
        title = 'everything'
        [whisker]
        length_mm = 20
        base_radius_um = 30
        tip_radius_um = 4
        youngs_modulus_gpa = 3
        curvature = { parabola_per_mm = 0.02, vertex_mm = 1 }
        modulus_gradient.tip_to_base = 1.3
        projection.arc_stretch = 1.02
        [pole]
        radius_mm = 0.25
        [contact]
        friction = 0.1
        [grid]
        push_angle_deg = [10]
        distance_mm = [15]
    ";
    Scene::parse(text, "everything.toml").unwrap()
}

/// The end of a push at one distance.
fn end(scene: &Scene, distance_mm: f64, side: Side) -> Detachment {
    curve(&scene.whisker, &scene.pole, side, &[distance_mm])[0]
}

fn target(distance_mm: f64, side: Side, kind: DetachmentKind, push_angle_deg: f64) -> DesignTarget {
    let goal = match kind {
        DetachmentKind::PullOff => DesignGoal::PullOff,
        _ => DesignGoal::SlipOff,
    };
    DesignTarget { distance_mm, side, goal, value: push_angle_deg }
}

/// Every value does what is asked for, to the last of the tolerance.
fn assert_sound(scene: &Scene, parameter: Parameter, target: &DesignTarget, design: &Design) {
    for value in &design.values {
        let moved = scene.with_parameters(&[(parameter, *value)]).unwrap();
        let end = end(&moved, target.distance_mm, target.side);
        assert_eq!(Some(end.kind), target.goal.kind(), "{parameter:?} {value}");
        let miss = (end.push_angle_deg.unwrap() - target.value).abs();
        assert!(miss <= 1e-9, "{parameter:?} {value}: {miss}");
    }
}

/// A scene's own numbers come back from where its whisker detaches. The worst of them is off by 2e-13 of itself.
#[test]
fn known_values_come_back() {
    let scene = everything();
    let spiral = include_str!("../scenes/euler_spiral.toml");
    let spiral = Scene::parse(spiral, "euler_spiral.toml").unwrap();
    let mut found = 0;
    for (scene, distance, side) in
        [(&scene, 13.0, Side::Cf), (&scene, 18.5, Side::Cb), (&spiral, 12.0, Side::Cb)]
    {
        let reached = end(scene, distance, side);
        let target = target(distance, side, reached.kind, reached.push_angle_deg.unwrap());
        for parameter in Parameter::ALL {
            let Some(value) = parameter.value(scene) else {
                continue;
            };
            if parameter == Parameter::YoungsModulusGpa {
                continue;
            }
            let design = design(scene, parameter, &target).unwrap();
            assert_sound(scene, parameter, &target, &design);
            let off = design.values.iter().map(|other| (other - value).abs());
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off <= 1e-9 * value.abs(), "{parameter:?} {side:?}: {off}");
            found += 1;
        }
    }
    assert_eq!(found, 2 * 10 + 7);
}

/// The push angle of the robot's whisker is least at some curvature: above it there are two solutions, below it none.
#[test]
fn a_pair_of_solutions_is_found_however_close() {
    let scene = robot();
    let parameter = Parameter::ParabolaPerMm;
    let ask = |push| {
        let target = target(60.0, Side::Cb, DetachmentKind::SlipOff, push);
        let design = design(&scene, parameter, &target).unwrap();
        assert_sound(&scene, parameter, &target, &design);
        design
    };
    let push = |value| {
        let moved = scene.with_parameters(&[(parameter, value)]).unwrap();
        end(&moved, 60.0, Side::Cb).push_angle_deg.unwrap()
    };
    // By thirds.
    let (mut low, mut high) = (0.005, 0.02);
    while high - low > 1e-7 {
        let [one, other] = [2.0 * low + high, low + 2.0 * high].map(|sum| sum / 3.0);
        if push(one) < push(other) {
            high = other;
        } else {
            low = one;
        }
    }
    let least = push(low);
    for above in [1.0, 1e-2, 1e-4, 1e-6, 1e-8] {
        let values = ask(least + above).values;
        let [one, other] = values[..] else {
            panic!("{above}: {values:?}");
        };
        assert!(one < low && low < other, "{above}: {values:?} {low}");
        assert_eq!(ask(least - above).values, [0.0; 0]);
    }
}

/// Slip-off and pull-off follow each other as the taper falls; what belongs to the other kind is no solution.
#[test]
fn kinds_are_told_apart() {
    let scene = robot();
    let ask = |kind, push| {
        let target = target(60.0, Side::Cb, kind, push);
        let design = design(&scene, Parameter::Taper, &target).unwrap();
        assert_sound(&scene, Parameter::Taper, &target, &design);
        design
    };
    let far = ask(DetachmentKind::SlipOff, 1.0);
    assert_eq!(far.values, [0.0; 0]);
    assert_eq!(far.range, [0.0, 1.0]);
    let [least, corner] = far.reached(DetachmentKind::SlipOff).unwrap();
    let [same, most] = far.reached(DetachmentKind::PullOff).unwrap();
    assert!(least < corner && same < most && (same - corner).abs() < 1e-9);
    assert_eq!(far.reached(DetachmentKind::OutOfReach), None);
    // On both sides of the corner, far within one step of the scan.
    for away in [1e-7, 0.1] {
        assert_eq!(ask(DetachmentKind::SlipOff, corner - away).values.len(), 1);
        assert_eq!(ask(DetachmentKind::PullOff, corner + away).values.len(), 1);
        assert_eq!(ask(DetachmentKind::SlipOff, corner + away).values.len(), 0);
        assert_eq!(ask(DetachmentKind::PullOff, corner - away).values.len(), 0);
    }
    // The ends of the range are solutions, too.
    for (kind, push, value) in
        [(DetachmentKind::SlipOff, least, 1.0), (DetachmentKind::PullOff, most, 0.0)]
    {
        let values = ask(kind, push).values;
        assert!(values.iter().any(|solution| (solution - value).abs() < 1e-6), "{values:?}");
    }
}

/// A whisker that just reaches the pole: between the last length that does not and the next sample.
#[test]
fn solutions_next_to_out_of_reach_are_found() {
    let cylinder = include_str!("../scenes/cylinder.toml");
    let cylinder = Scene::parse(cylinder, "cylinder.toml").unwrap();
    for push in [1.0, 0.01] {
        let target = target(19.0, Side::Cb, DetachmentKind::PullOff, push);
        let design = design(&cylinder, Parameter::LengthMm, &target).unwrap();
        assert_sound(&cylinder, Parameter::LengthMm, &target, &design);
        assert_eq!(design.values.len(), 1, "{push}");
    }
}

#[test]
fn what_cannot_be_asked_for_is_refused() {
    let scene = robot();
    let asked = target(60.0, Side::Cb, DetachmentKind::SlipOff, 30.0);
    let why = design(&scene, Parameter::Friction, &asked).unwrap_err();
    let said = why.to_string();
    assert!(matches!(why, DesignError::Lacking { .. }));
    for part in ["friction: must be one of length_mm, ", "taper", "it has no contact.friction"] {
        assert!(said.contains(part), "{said}");
    }
    let measured =
        include_str!("../scenes/measured.toml").replace("\"measured.csv\"", "[[0, 30], [20, 1.5]]");
    let measured = Scene::parse(&measured, "measured.toml").unwrap();
    let near = DesignTarget { distance_mm: 15.0, ..asked };
    let why = design(&measured, Parameter::LengthMm, &near).unwrap_err();
    assert!(why.to_string().contains("accepts no value but 20 for whisker.length_mm"), "{why}");
    assert!(matches!(design(&measured, Parameter::Taper, &near), Err(DesignError::Lacking { .. })));
    let axis = scene.to_builder().sweep(Parameter::ParabolaPerMm, [0.004]).build().unwrap();
    let why = design(&axis, Parameter::ParabolaPerMm, &asked).unwrap_err();
    assert_eq!(why, DesignError::Sweep("grid.curvature_per_mm"));
    let far = DesignTarget { distance_mm: 1e9, ..asked };
    assert!(matches!(design(&scene, Parameter::Taper, &far), Err(DesignError::Distance(_))));
}

/// Nothing that detaches depends on Young's modulus: every value reaches the target, or none does.
#[test]
fn a_number_that_does_not_matter_has_all_values_or_none() {
    let scene = robot();
    let slip_off = end(&scene, 60.0, Side::Cb).push_angle_deg.unwrap();
    for (push, is_reached) in [(slip_off, true), (slip_off + 1.0, false)] {
        let target = target(60.0, Side::Cb, DetachmentKind::SlipOff, push);
        let design = design(&scene, Parameter::YoungsModulusGpa, &target).unwrap();
        assert_eq!(design.values, [0.0; 0]);
        let all = [design.range];
        assert_eq!(design.spans, if is_reached { &all[..] } else { &[] });
        let [low, high] = design.reached(DetachmentKind::SlipOff).unwrap();
        assert!(high - low < 1e-9);
    }
}

/// A range of values of which each reaches the target, and no value below, is not a list of the search's own values.
#[test]
fn values_that_do_not_matter_in_a_range_are_the_range() {
    let scene = |tip_radius_um: f64, follicle: &str| {
        let text = format!(
            "title = 'point pole'
            [whisker]
            length_mm = 20
            base_radius_um = 30
            tip_radius_um = {tip_radius_um}
            youngs_modulus_gpa = 3
            {follicle}
            [contact]
            friction = 0.3
            [grid]
            push_angle_deg = [10]
            distance_mm = [10]"
        );
        Scene::parse(&text, "point.toml").unwrap()
    };
    let clamped = scene(30.0, "");
    let soft = scene(8.0, "follicle.stiffness_nnm_per_rad = 5000");
    let cylinder = include_str!("../scenes/cylinder.toml");
    let cylinder = Scene::parse(cylinder, "cylinder.toml").unwrap();
    for (scene, distance_mm, side, goal, parameter) in [
        (&soft, 8.0, Side::Cb, DesignGoal::MaxForce, Parameter::FollicleStiffness),
        (&clamped, 5.0, Side::Cb, DesignGoal::MaxForce, Parameter::LengthMm),
        (&cylinder, 5.0, Side::Cf, DesignGoal::SlipOff, Parameter::LengthMm),
    ] {
        // The search's own peaks: 2,000 states are not accurate enough.
        let value_at = |value: f64| {
            let moved = scene.with(parameter, value).unwrap();
            let (whisker, pole) = (&moved.whisker, &moved.pole);
            let branch = StableBranch::new(whisker, pole, side, distance_mm).unwrap();
            match goal.load() {
                Some(load) => branch.peak(load).size,
                None => end(&moved, distance_mm, side).push_angle_deg.unwrap(),
            }
        };
        let own = parameter.value(scene).unwrap();
        let value = value_at(own);
        let target = DesignTarget { distance_mm, side, goal, value };
        let design = design(scene, parameter, &target).unwrap();
        let [[least, greatest]] = design.spans[..] else {
            panic!("{parameter:?} {:?} {:?}", design.spans, design.values);
        };
        assert_eq!(design.values, [0.0; 0], "{parameter:?}");
        assert!(least < own && own < greatest, "{least} {own} {greatest}");
        for part in [0.0, 0.01, 0.3, 0.7, 1.0] {
            let inside = least + part * (greatest - least);
            let off = value_at(inside) / value - 1.0;
            assert!(off.abs() <= 1.01e-6, "{parameter:?} {inside} {off:e}");
        }
        let below = value_at(0.95 * least);
        let off = below / value - 1.0;
        assert!(off.abs() > 1e-6, "{parameter:?} {least}: {off:e}");
    }
}

/// With each solution, the largest load of a push is the target: over 2,000 states of its branch none is larger, and one is almost as large.
/// A load of any kind grows with the size of a whisker of fixed shape, so that the scene's own value comes back.
#[test]
fn the_largest_load_of_a_push_reaches_the_target() {
    type Load = fn(&BranchPoint) -> f64;
    let goals: [(DesignGoal, Load); 3] = [
        (DesignGoal::MaxForce, |point| point.force_un),
        (DesignGoal::MaxMoment, |point| point.base_moment_nnm.abs()),
        (DesignGoal::MaxStrain, |point| point.peak_strain),
    ];
    let cylinder = include_str!("../scenes/cylinder.toml");
    let cylinder = Scene::parse(cylinder, "cylinder.toml").unwrap();
    let mut before_the_end = 0;
    for (scene, distance_mm, side) in
        [(&robot(), 60.0, Side::Cb), (&robot(), 95.0, Side::Cb), (&cylinder, 6.0, Side::Cf)]
    {
        let states = |scene: &Scene| {
            let branch = Branch::new(&scene.whisker, &scene.pole, side, distance_mm).unwrap();
            branch.points(4000).unwrap()
        };
        let own_states = states(scene);
        for (goal, load) in goals {
            let most = |states: &[BranchPoint]| {
                let stable: Vec<f64> = states.iter().filter(|p| p.stable).map(load).collect();
                let most = stable.iter().copied().fold(0.0, f64::max);
                (most, most > stable[stable.len() - 1])
            };
            let (value, is_before) = most(&own_states);
            before_the_end += u32::from(is_before);
            let target = DesignTarget { distance_mm, side, goal, value };
            let parameter = Parameter::BaseRadiusUm;
            let design = design(scene, parameter, &target).unwrap();
            let current = parameter.value(scene).unwrap();
            let off = design.values.iter().map(|value| (value / current - 1.0).abs());
            let off = off.fold(f64::INFINITY, f64::min);
            let values = &design.values;
            assert!(off < 2e-6, "{goal:?} {side:?} at {distance_mm}: {values:?}");
            for found in &design.values {
                let (reached, _) = most(&states(&scene.with(parameter, *found).unwrap()));
                let off = reached / value - 1.0;
                assert!((-1e-5..2e-6).contains(&off), "{goal:?} {found}: {reached} {value}");
            }
        }
    }
    assert!(before_the_end >= 4, "{before_the_end}");
}

/// A design of several numbers within the limits of the scene.
fn varied(variables: &[Variable]) -> DesignVaried {
    let variables = variables.iter().copied();
    let variables = variables.map(|variable| DesignVariable { variable, limits: None });
    variables.collect()
}

/// Largest values of a push over 2,000 stable states: contact force, moment and strain.
fn largest(scene: &Scene, distance_mm: f64, side: Side) -> [f64; 3] {
    let branch = Branch::new(&scene.whisker, &scene.pole, side, distance_mm).unwrap();
    let points = branch.points(4000).unwrap();
    let stable = points.iter().filter(|point| point.stable);
    stable.fold([0.0; 3], |[force, moment, strain], point| {
        [
            point.contact_force_un.max(force),
            point.base_moment_nnm.abs().max(moment),
            point.peak_strain.max(strain),
        ]
    })
}

/// What a push reaches, by goal.
fn reached(scene: &Scene, distance_mm: f64, side: Side, goal: DesignGoal) -> f64 {
    let [force, moment, strain] = largest(scene, distance_mm, side);
    match goal {
        DesignGoal::MaxForce => force,
        DesignGoal::MaxMoment => moment,
        DesignGoal::MaxStrain => strain,
        _ => end(scene, distance_mm, side).push_angle_deg.unwrap(),
    }
}

const TAPER: Variable = Variable::Parameter(Parameter::Taper);
const BASE: Variable = Variable::Parameter(Parameter::BaseRadiusUm);
const MODULUS: Variable = Variable::Parameter(Parameter::YoungsModulusGpa);

/// Numbers of a scene come back from what its push reaches: two, and three, of different kinds. Each solution is verified by its own push.
#[test]
fn several_numbers_come_back_from_as_many_targets() {
    use DesignGoal::{MaxForce, MaxMoment, MaxStrain, SlipOff};
    let (robot, rough) = (robot(), everything());
    for (scene, side, distance_mm, variables, goals) in [
        (&robot, Side::Cb, 60.0, &[BASE, TAPER][..], &[SlipOff, MaxMoment][..]),
        (&robot, Side::Cb, 60.0, &[Variable::DistanceMm, BASE], &[SlipOff, MaxForce]),
        (&robot, Side::Cb, 60.0, &[BASE, TAPER, MODULUS], &[SlipOff, MaxMoment, MaxStrain]),
        (&rough, Side::Cf, 13.0, &[BASE, TAPER], &[SlipOff, MaxForce]),
    ] {
        let target = |goal: &DesignGoal| DesignTarget {
            distance_mm,
            side,
            goal: *goal,
            value: reached(scene, distance_mm, side, *goal),
        };
        let targets: Vec<DesignTarget> = goals.iter().map(target).collect();
        let found = designs(scene, &varied(variables), &targets).unwrap();
        assert!(!found.is_undetermined && found.nearest.is_none(), "{found:?}");
        let current = |variable: &Variable| variable.value(scene).unwrap_or(distance_mm);
        // The largest values of 2,000 states are up to 1e-6 below those of the push.
        let is_own = |values: &Vec<f64>| {
            let mut pairs = values.iter().zip(variables);
            pairs.all(|(value, variable)| (value / current(variable) - 1.0).abs() < 1e-4)
        };
        assert!(found.solutions.iter().any(is_own), "{goals:?}: {found:?}");
        for values in &found.solutions {
            let mut place = (scene.clone(), distance_mm);
            let set = varied(variables).changes(scene, values);
            place.0 = place.0.with_parameters(&set).unwrap();
            if variables[0] == Variable::DistanceMm {
                place.1 = values[0];
            }
            for target in &targets {
                let value = reached(&place.0, place.1, side, target.goal);
                assert!(
                    (value / target.value - 1.0).abs() < 1e-5,
                    "{target:?}: {values:?} {value}"
                );
            }
        }
    }
}

/// The largest moment grows with the size of the whisker: of a moment that is too large, the nearest values are at the limit of the radius.
#[test]
fn nearest_values_are_at_the_limit_that_stops_them() {
    let scene = robot();
    let slip_off = target(60.0, Side::Cb, DetachmentKind::SlipOff, 35.0);
    let moment = DesignTarget { goal: DesignGoal::MaxMoment, value: 1e9, ..slip_off };
    let mut varied = varied(&[BASE, TAPER]);
    let most = 1.1 * scene.whisker.base_radius_um;
    varied.variables[0].limits = Some([100.0, most]);
    let found = designs(&scene, &varied, &[slip_off, moment]).unwrap();
    assert_eq!((found.solutions.len(), found.ranges[0]), (0, [100.0, most]));
    let nearest = found.nearest.unwrap();
    assert_eq!((nearest.values[0], nearest.is_at_limit[0]), (most, true));
}

/// No angle and no ratio of loads depends on the modulus: with it alone beside a load, nothing else is determined.
#[test]
fn a_line_of_solutions_is_reported() {
    let scene = robot();
    let of = |goal, factor: f64| DesignTarget {
        distance_mm: 60.0,
        side: Side::Cb,
        goal,
        value: factor * reached(&scene, 60.0, Side::Cb, goal),
    };
    // The scene's own slip-off at any radius of the same shape, and the moment by radius or modulus.
    let targets = [of(DesignGoal::MaxForce, 2.0), of(DesignGoal::MaxMoment, 2.0)];
    let mut varied = varied(&[BASE, MODULUS]);
    varied.keeps_taper = true;
    assert!(designs(&scene, &varied, &targets).unwrap().is_undetermined);
}

/// A distance in parts of the length follows the length; a kept taper takes the radius at the tip along; the scene's own distance comes back.
#[test]
fn what_follows_a_varied_number_follows() {
    let scene = robot();
    let whisker = &scene.whisker;
    let length = DesignVaried { distance_to_length: Some(0.6), ..Parameter::LengthMm.into() };
    let short = scene.with(Parameter::LengthMm, 0.8 * whisker.length_mm).unwrap();
    let short_end = end(&short, 0.6 * short.whisker.length_mm, Side::Cb);
    let sought = target(
        0.6 * whisker.length_mm,
        Side::Cb,
        short_end.kind,
        short_end.push_angle_deg.unwrap(),
    );
    let found = design(&scene, length, &sought).unwrap();
    let off = found.values.iter().map(|distance| (distance / short.whisker.length_mm - 1.0).abs());
    assert!(off.fold(f64::INFINITY, f64::min) < 1e-9, "{found:?}");

    let keeping = DesignVaried { keeps_taper: true, ..Parameter::BaseRadiusUm.into() };
    let load = DesignTarget {
        distance_mm: 60.0,
        side: Side::Cb,
        goal: DesignGoal::MaxMoment,
        value: 2.0 * reached(&scene, 60.0, Side::Cb, DesignGoal::MaxMoment),
    };
    let found = design(&scene, keeping.clone(), &load).unwrap();
    // A whisker of the same shape: the moment grows with the fourth power of the radius.
    let wanted = whisker.base_radius_um * 2.0_f64.powf(0.25);
    assert!((found.values[0] / wanted - 1.0).abs() < 1e-5, "{:?} {wanted}", found.values);
    let wider = scene.with_parameters(&keeping.changes(&scene, &found.values)).unwrap();
    assert!((wider.whisker.taper() - whisker.taper()).abs() < 1e-12);
    let other = DesignVaried { keeps_taper: true, ..Parameter::LengthMm.into() };
    assert_eq!(design(&scene, other, &load), Err(DesignError::NoTaper));

    let reached = end(&scene, 60.0, Side::Cb);
    let sought = target(45.0, Side::Cb, reached.kind, reached.push_angle_deg.unwrap());
    let found = design(&scene, Variable::DistanceMm, &sought).unwrap();
    assert!(found.values.iter().any(|value| (value - 60.0).abs() < 1e-7), "{found:?}");
}

#[test]
fn designs_with_other_counts_and_numbers_are_refused() {
    let scene = robot();
    let slip_off = target(60.0, Side::Cb, DetachmentKind::SlipOff, 30.0);
    let moment = DesignTarget { goal: DesignGoal::MaxMoment, value: 1e6, ..slip_off };
    let other = DesignTarget { distance_mm: 50.0, ..moment };
    let why = |variables: &[Variable], targets: &[DesignTarget]| {
        designs(&scene, &varied(variables), targets).unwrap_err()
    };
    let tip = Variable::from(Parameter::TipRadiusUm);
    let counts = |variables, targets| DesignError::Targets { variables, targets };
    assert_eq!(why(&[TAPER], &[slip_off, moment]), counts(1, 2));
    assert_eq!(why(&[TAPER, BASE], &[slip_off, slip_off]), counts(2, 1));
    assert_eq!(why(&[TAPER, BASE], &[slip_off, other]), counts(2, 1));
    let twice = why(&[TAPER, tip], &[slip_off, moment]);
    assert_eq!(twice, DesignError::Twice(TAPER, tip));
    let twice = why(&[TAPER, TAPER], &[slip_off, moment]);
    assert_eq!(twice.to_string(), "taper: is given twice");
    assert_eq!(
        why(&[Variable::PushAngleDeg], &[slip_off]).to_string(),
        "push_angle_deg: must be a parameter of the scene, or distance_mm"
    );
    let mut limited = varied(&[TAPER]);
    limited.variables[0].limits = Some([2.0, 3.0]);
    assert_eq!(
        design(&scene, limited, &slip_off).unwrap_err().to_string(),
        "taper: must lie between 0 and 1, which the scene accepts; the limits are 2 to 3"
    );
}

/// The search of one number begins with 128 pushes; that of two with about 600.
#[test]
fn progress_counts_pushes() {
    let scene = robot();
    let of = |goal| DesignTarget {
        distance_mm: 60.0,
        side: Side::Cb,
        goal,
        value: reached(&scene, 60.0, Side::Cb, goal),
    };
    let targets = [DesignGoal::SlipOff, DesignGoal::MaxMoment].map(of);
    let (pushes, never) = (AtomicUsize::new(0), AtomicBool::new(false));
    let on_progress = |more| {
        pushes.fetch_add(more, Ordering::Relaxed);
    };
    design_until(&scene, TAPER, &targets[0], &on_progress, &never).unwrap();
    assert!(pushes.swap(0, Ordering::Relaxed) >= 128);
    ends_between(&scene, TAPER, &targets[0], [0.8, 0.9], &on_progress).unwrap();
    assert!(pushes.swap(0, Ordering::Relaxed) >= 128);
    designs_until(&scene, &varied(&[BASE, TAPER]), &targets, &on_progress, &never).unwrap();
    assert!(pushes.into_inner() >= 500);
}
