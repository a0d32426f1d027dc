//! Numbers of steps.

use whiskmap_mechanics::rod::Rod;
use whiskmap_mechanics::shooting::Resolution;

/// Numbers of steps against the smallest integer of three significant bits that is as large. A perfect cone without a load needs
/// `tau` steps of length 1.
#[test]
fn steps_are_rounded_up_to_three_bits() {
    let resolution = Resolution { least: 0, longest: 1.0, fewest: 1 };
    let cone = Rod { taper: 1.0, ..Rod::default() };
    let steps = |wanted: f64| resolution.steps(&cone, wanted, 0.0);
    for quarters in 0..4 * 9000 {
        let wanted = 0.25 * f64::from(quarters);
        let fits = |steps: &u32| {
            let unit = (steps.next_power_of_two() / 8).max(1);
            f64::from(*steps) >= wanted && steps.is_multiple_of(unit)
        };
        let expected = (1..=8192).find(fits).unwrap_or(8192);
        assert_eq!(steps(wanted), expected, "{wanted}");
    }
    assert_eq!(steps(f64::NAN), 1);
    assert_eq!(steps(f64::INFINITY), 8192);
}

/// The number of steps for the load is rounded like the number for the length.
#[test]
fn steps_for_the_load_are_rounded_as_well() {
    let resolution = Resolution { least: 20, longest: f64::INFINITY, fewest: 1 };
    for load in 0..2000 {
        let steps = resolution.steps(&Rod::default(), 1.0, 0.01 * f64::from(load));
        let wanted = 20.0 * (0.28 + 0.195 * (0.01 * f64::from(load)).sqrt());
        let unit = (steps.next_power_of_two() / 8).max(1);
        assert!(steps.is_multiple_of(unit));
        let over = f64::from(steps) - wanted;
        assert!((0.0..f64::from(unit)).contains(&over), "{load}: {over}");
    }
}
