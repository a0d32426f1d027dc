//! Whiskers drawn from the uncertainty of a scene: the same ones everywhere, spread as derivatives foretell.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use whiskmap::Side;
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::trace::{DetachmentKind, curve};
use whiskmap::uncertainty::{DrawError, Draws, EndSpread};

/// The cone with a rough pole and a stiff tip, at a few distances, with a table of deviations.
fn scene(uncertainty: &str) -> Scene {
    let text = format!(
        "
        title = 'uncertain'
        [whisker]
        length_mm = 20
        base_radius_um = 30
        tip_radius_um = 3
        youngs_modulus_gpa = 3
        curvature = {{ parabola_per_mm = 0.02, vertex_mm = 2 }}
        modulus_gradient.tip_to_base = 1.3
        projection.arc_stretch = 1.03
        [pole]
        radius_mm = 0.25
        [contact]
        friction = 0.1
        [grid]
        push_angle_deg = [10]
        distance_mm = [6, 13, 18]
        [uncertainty]
        {uncertainty}"
    );
    Scene::parse(&text, "uncertain.toml").unwrap()
}

fn spreads(scene: &Scene, samples: usize, seed: u64) -> Vec<EndSpread> {
    let draws = Draws::new(scene, samples, seed).unwrap();
    let spread = |side| draws.spread(Resolution::FINE, side, &|| ());
    Side::BOTH.into_iter().flat_map(spread).collect()
}

/// A small share of each number, all at once. Sampling leaves 0.7 % of 10,000 samples' deviation (1/sqrt(2n)).
#[test]
fn small_deviations_spread_as_derivatives_foretell() {
    let undrawn = scene("length_mm = 0");
    let table: Vec<String> = Parameter::ALL
        .into_iter()
        .filter(|one| !matches!(one, Parameter::Taper))
        .filter_map(|one| {
            let deviation = 1e-4 * one.value(&undrawn)?;
            Some(format!("{} = {deviation:?}", one.name()))
        })
        .collect();
    assert_eq!(table.len(), 10);
    let rows = spreads(&scene(&table.join("\n")), 10_000, 1);
    assert_eq!(rows.len(), 6);
    for row in rows {
        let [sd, foretold] = [row.sd_deg, row.sd_first_order_deg].map(Option::unwrap);
        assert!((sd / foretold - 1.0).abs() < 0.02, "{row:?}");
        // 90 % of a normal distribution lie within 1.645 deviations, 50 % within 0.6745.
        let wide = (row.p95_deg.unwrap() - row.p5_deg.unwrap()) / (2.0 * 1.644_854);
        let narrow = (row.p75_deg.unwrap() - row.p25_deg.unwrap()) / (2.0 * 0.674_490);
        for other in [wide, narrow] {
            assert!((other / foretold - 1.0).abs() < 0.04, "{row:?}");
        }
        let push = row.push_angle_deg.unwrap();
        for middle in [row.mean_deg, row.p50_deg] {
            assert!((middle.unwrap() - push).abs() < 0.05 * sd, "{row:?}");
        }
        assert_eq!(
            [row.slip_off, row.pull_off, row.out_of_reach, row.unresolved],
            [10_000, 0, 0, 0]
        );
    }
}

/// Against derivatives taken here, number by number; at the limit of a range only one side has them.
#[test]
fn first_order_is_the_sum_of_squares() {
    let deviations = [
        (Parameter::LengthMm, 0.3),
        (Parameter::Taper, 0.01),
        (Parameter::VertexMm, 0.5),
        (Parameter::PoleRadiusMm, 0.05),
    ];
    let table = deviations.map(|(one, sd)| format!("{} = {sd}", one.name()));
    let scene = scene(&table.join("\n"));
    let distances = &scene.grid.distance_mm;
    let pushes = |scene: &Scene, side| -> Vec<f64> {
        let ends = curve(&scene.whisker, &scene.pole, side, distances);
        ends.iter().map(|end| end.push_angle_deg.unwrap()).collect()
    };
    for (i, row) in spreads(&scene, 2, 1).iter().enumerate() {
        let squares = deviations.iter().map(|(one, sd)| {
            let value = one.value(&scene).unwrap();
            let [before, after] = [-1e-5, 1e-5].map(|step| {
                let moved = scene.with_parameters(&[(*one, value + step)]).unwrap();
                pushes(&moved, row.side)[i % 3]
            });
            ((after - before) / 2e-5 * sd).powi(2)
        });
        let expected = squares.sum::<f64>().sqrt();
        let found = row.sd_first_order_deg.unwrap();
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
    }
}

/// With a taper that varies, the radius at the tip follows that at the base, and no angle depends on the size of a cone.
#[test]
fn a_base_that_varies_with_the_taper_moves_no_angle() {
    let foretold = |uncertainty: &str| -> Vec<f64> {
        let rows = spreads(&scene(uncertainty), 2, 1);
        rows.iter().filter_map(|row| row.sd_first_order_deg).collect()
    };
    let both = foretold("base_radius_um = 5\ntaper = 0.001");
    let alone = foretold("taper = 0.001");
    assert!(!both.is_empty() && both.len() == alone.len());
    for (both, alone) in both.iter().zip(alone) {
        assert!((both / alone - 1.0).abs() < 1e-9, "{both} {alone}");
    }
}

#[test]
fn every_row_of_a_profile_varies() {
    let measured = include_str!("../scenes/measured.toml")
        .replace("\"measured.csv\"", "[[0, 30], [8, 20], [20, 4]]")
        .replace("distance_mm = { from = 2, to = 20, count = 512 }", "distance_mm = [12]");
    let scene = Scene::parse(
        &format!("{measured}\n[uncertainty]\nprofile_radius_um = 0.5\n"),
        "measured.toml",
    );
    let scene = scene.unwrap();
    let rows = [[0.0, 30.0], [8.0, 20.0], [20.0, 4.0]];
    for row in spreads(&scene, 400, 1) {
        let squares = (0..3).map(|place| {
            let [before, after] = [-1e-4, 1e-4].map(|step| {
                let mut rows = rows;
                rows[place][1] += step;
                let moved = scene.to_builder().profile(rows).build().unwrap();
                let end = curve(&moved.whisker, &moved.pole, row.side, &[12.0])[0];
                end.push_angle_deg.unwrap()
            });
            ((after - before) / 2e-4 * 0.5).powi(2)
        });
        let expected = squares.sum::<f64>().sqrt();
        let found = row.sd_first_order_deg.unwrap();
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        // 400 samples leave 3.5 %, and the deviations are not small.
        assert!((row.sd_deg.unwrap() / found - 1.0).abs() < 0.15, "{row:?}");
    }
}

/// A measured radius changes all smoothed ones, and the cone beyond them.
#[test]
fn every_row_of_a_smooth_profile_varies() {
    // Errors of 0.1 um keep the degree where the rows move a little.
    let row = |i: u32| {
        [2.0 * f64::from(i), 30.0 - 3.0 * f64::from(i) + [0.1, -0.1, -0.05, 0.08][i as usize % 4]]
    };
    let rows: Vec<[f64; 2]> = (0..9).map(row).collect();
    let text = format!(
        "
        title = 'smooth'
        whisker.length_mm = 16
        whisker.youngs_modulus_gpa = 3
        whisker.profile = {{ rows = {rows:?}, smooth = true, tip_extension_mm = 1 }}
        pole.radius_mm = 0.25
        grid = {{ push_angle_deg = [10], distance_mm = [9] }}
        uncertainty.profile_radius_um = 0.02"
    );
    let scene = Scene::parse(&text, "smooth.toml").unwrap();
    assert_eq!(scene.smooth_radii().unwrap().degree, 1);
    for row in spreads(&scene, 400, 1) {
        let squares = (0..rows.len()).map(|place| {
            let [before, after] = [-1e-4, 1e-4].map(|step| {
                let mut rows = rows.clone();
                rows[place][1] += step;
                let moved = scene.to_builder().profile(rows).build().unwrap();
                let end = curve(&moved.whisker, &moved.pole, row.side, &[9.0])[0];
                end.push_angle_deg.unwrap()
            });
            ((after - before) / 2e-4 * 0.02).powi(2)
        });
        let expected = squares.sum::<f64>().sqrt();
        let found = row.sd_first_order_deg.unwrap();
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        // 400 samples leave 3.5 %.
        assert!((row.sd_deg.unwrap() / found - 1.0).abs() < 0.15, "{row:?}");
    }
}

#[test]
fn equal_seeds_draw_equal_whiskers_on_any_number_of_threads() {
    let scene = scene("length_mm = 0.4\ntip_radius_um = 0.5");
    let one = spreads(&scene, 50, 7);
    assert_eq!(one, spreads(&scene, 50, 7));
    assert_ne!(one, spreads(&scene, 50, 8));
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        assert_eq!(pool.unwrap().install(|| spreads(&scene, 50, 7)), one);
    }
}

/// A draw that the scene refuses is drawn again: the tip of a perfect cone is never thinner than nothing.
#[test]
fn draws_outside_of_the_limits_are_drawn_again() {
    let limit = scene("tip_radius_um = 0.5")
        .with(Parameter::ArcStretch, 1.0)
        .and_then(|scene| scene.with(Parameter::TipRadiusUm, 0.0))
        .unwrap();
    let draws = Draws::new(&limit, 200, 1).unwrap();
    // Half of all draws; 200 more are expected, give or take 20.
    assert!((120..280).contains(&draws.refused), "{}", draws.refused);
    let rows = draws.spread(Resolution::FINE, Side::Cb, &|| ());
    // A thicker tip holds on for longer.
    for row in rows {
        assert!(row.p5_deg.unwrap() > row.push_angle_deg.unwrap(), "{row:?}");
        assert!(row.sd_first_order_deg.unwrap() > 0.0);
    }
}

#[test]
fn ends_out_of_reach_are_counted() {
    let scene = scene("length_mm = 0.5").to_builder().distance_mm([19.3]).build().unwrap();
    for row in spreads(&scene, 100, 1) {
        assert!(row.out_of_reach > 10 && row.out_of_reach < 90, "{row:?}");
        let all = row.slip_off + row.pull_off + row.out_of_reach + row.unresolved;
        assert_eq!((all, row.unresolved), (100, 0));
    }
    let never = scene.to_builder().distance_mm([40.0]).build().unwrap();
    for row in spreads(&never, 10, 1) {
        assert_eq!((row.kind, row.out_of_reach), (DetachmentKind::OutOfReach, 10));
        let numbers = [row.p5_deg, row.p50_deg, row.mean_deg, row.sd_deg, row.sd_first_order_deg];
        assert_eq!(numbers, [None; 5]);
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let cone = include_str!("../scenes/cone.toml");
    let cone = Scene::parse(cone, "cone.toml").unwrap();
    let why = |scene: &Scene, samples| Draws::new(scene, samples, 1).unwrap_err();
    assert_eq!(why(&cone, 10), DrawError::NoTable);
    let many = scene("length_mm = 1");
    let too_many = DrawError::TooMany { ends: 30_000_000, distances: 3 };
    assert_eq!(why(&many, 10_000_000), too_many);
    let axis = many.to_builder().sweep(Parameter::ParabolaPerMm, [0.02]).build().unwrap();
    assert_eq!(why(&axis, 10), DrawError::Sweep("grid.curvature_per_mm"));
    let wide =
        scene("length_mm = 1e5\nbase_radius_um = 1e5\nvertex_mm = 1e5\npole_radius_mm = 1e5");
    let said = why(&wide, 10).to_string();
    assert!(said.starts_with("1000 draws in a row are outside"), "{said}");
}

/// Loads are proportional to the fourth power of the radii, and the push angle does not depend on them. The tip's cone matters to pull-offs
/// alone.
#[test]
fn measured_radii_spread_loads_by_their_factor_and_pull_offs_by_their_tip() {
    let spread = |uncertainty: &str| {
        let text = format!(
            "
            title = 'measured'
            [whisker]
            length_mm = 18.5
            youngs_modulus_gpa = 3
            curvature = {{ parabola_per_mm = 0.02 }}
            [whisker.profile]
            rows = [[0, 30], [9, 21], [18.5, 11.5]]
            profile_scale = 1
            tip_extension_mm = 1.6
            [grid]
            push_angle_deg = [10]
            distance_mm = [10, 19.2]
            [uncertainty]
            {uncertainty}"
        );
        let rows = spreads(&Scene::parse(&text, "measured.toml").unwrap(), 2_000, 1);
        [rows[2], rows[3]]
    };
    for row in spread("profile_scale = 1e-3") {
        assert!(row.sd_deg.unwrap() < 1e-9, "{row:?}");
        let force = row.force_un.unwrap();
        // Sampling leaves 1.6 % of the deviation (1/sqrt(2n)), as above.
        let loads = [
            (force, row.force_mean_un, row.force_sd_un, row.force_p95_un),
            (
                row.base_moment_nnm.unwrap(),
                row.base_moment_mean_nnm,
                row.base_moment_sd_nnm,
                row.base_moment_p95_nnm,
            ),
        ];
        for (load, mean, sd, p95) in loads {
            let part = sd.unwrap() / load.abs();
            assert!((part / 4e-3 - 1.0).abs() < 0.05, "{row:?}");
            assert!((mean.unwrap() / load - 1.0).abs() < 4e-4, "{row:?}");
            let wide = (p95.unwrap() - load) / (1.644_854 * sd.unwrap());
            assert!((wide - 1.0).abs() < 0.1, "{row:?}");
        }
    }
    let [near, far] = spread("tip_extension_mm = 1e-3");
    assert_eq!([near.slip_off, far.pull_off], [2_000; 2], "{near:?} {far:?}");
    assert!(near.sd_deg.unwrap() < 1e-9, "{near:?}");
    let [sd, foretold] = [far.sd_deg, far.sd_first_order_deg].map(Option::unwrap);
    assert!(sd > 1e-4 && (sd / foretold - 1.0).abs() < 0.06, "{far:?}");
}

/// The largest loads of samples are those of their pushes: proportional to the fourth power of the radii, and at least those at detachment.
#[test]
fn largest_loads_of_samples_spread_as_the_loads_of_one_push() {
    let text = "
        title = 'measured'
        [whisker]
        length_mm = 18.5
        youngs_modulus_gpa = 3
        curvature = { parabola_per_mm = 0.02 }
        [whisker.profile]
        rows = [[0, 30], [9, 21], [18.5, 11.5]]
        profile_scale = 1
        [grid]
        push_angle_deg = [10]
        distance_mm = [10]
        [uncertainty]
        profile_scale = 1e-3";
    let scene = Scene::parse(text, "measured.toml").unwrap();
    let draws = Draws::new(&scene, 200, 1).unwrap();
    for side in Side::BOTH {
        let largest = draws.largest(side, &|| ())[0];
        let end = draws.spread(Resolution::FINE, side, &|| ())[0];
        let branch = whiskmap::trace::Branch::new(&scene.whisker, &scene.pole, side, 10.0).unwrap();
        let points = branch.points(4000).unwrap();
        let most = |of: fn(&whiskmap::trace::BranchPoint) -> f64| {
            let stable = points.iter().filter(|point| point.stable);
            stable.map(of).fold(0.0, f64::max)
        };
        for (load, wanted, mean, sd, power) in [
            (
                largest.max_contact_force_un,
                most(|point| point.contact_force_un),
                largest.max_contact_force_mean_un,
                largest.max_contact_force_sd_un,
                4.0,
            ),
            (
                largest.max_base_moment_nnm,
                most(|point| point.base_moment_nnm.abs()),
                largest.max_base_moment_mean_nnm,
                largest.max_base_moment_sd_nnm,
                4.0,
            ),
            (
                largest.max_strain,
                most(|point| point.peak_strain),
                largest.max_strain_mean,
                largest.max_strain_sd,
                1.0,
            ),
        ] {
            let load = load.unwrap();
            // 2,000 states are up to 1e-6 below the largest one.
            assert!((-1e-9..2e-6).contains(&(load / wanted - 1.0)), "{side:?} {load} {wanted}");
            // 200 samples leave 5 % of the deviation, and 7 % of it in the mean.
            assert!((sd.unwrap() / load / (power * 1e-3) - 1.0).abs() < 0.2, "{largest:?}");
            assert!((mean.unwrap() / load - 1.0).abs() < 3e-4 * power, "{largest:?}");
        }
        let [largest, at_end] =
            [largest.max_base_moment_nnm, end.base_moment_nnm].map(Option::unwrap);
        assert!(largest > at_end.abs() * (1.0 + 1e-3), "{largest} {at_end}");
    }
}
