//! Extremum of a function near zero, between samples. The function has no sign change to bracket, so the golden section brackets its
//! extremum by three values.

use whiskmap_mechanics::numerics::least_between;

/// Returns `[argument, value]` of an extremum toward zero between three neighbouring `[argument, value]`, or of the first argument found beyond zero.
/// `None` without such an extremum, or if it is too far from zero for a smooth function.
pub fn toward_zero(
    [before, here, after]: [[f64; 2]; 3],
    mut value: impl FnMut(f64) -> f64,
) -> Option<[f64; 2]> {
    let sign = if here[1] < 0.0 { -1.0 } else { 1.0 };
    let [left, least, right] = [before, here, after].map(|place| sign * place[1]);
    let turns = least <= left && least <= right;
    // Three values leave to a smooth function much less than their own spread.
    if !turns || least > left.max(right) - least {
        return None;
    }
    let [at, found] = least_between([before[0], after[0]], 0.0, |at| sign * value(at));
    (found < least).then_some([at, sign * found])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola whose vertex lies between the samples, on either side of zero, at zero, and far from it.
    #[test]
    fn a_turn_is_found_between_samples() {
        let parabola = |vertex: f64, sign: f64| move |x: f64| sign * ((x - 0.3).powi(2) + vertex);
        for sign in [-1.0, 1.0] {
            let turn = |vertex: f64| {
                let value = parabola(vertex, sign);
                let places = [-1.0, 0.0, 1.0].map(|x| [x, value(x)]);
                toward_zero(places, value)
            };
            assert!(turn(-0.01).is_some_and(|[_, miss]| sign * miss < 0.0));
            assert!(
                turn(0.0).is_some_and(|[x, miss]| (x - 0.3).abs() < 1e-7 && miss.abs() < 1e-14)
            );
            assert!(turn(0.1).is_some_and(|[x, _]| (x - 0.3).abs() < 1e-7));
            assert_eq!(turn(10.0), None);
        }
        let line = |x: f64| x + 1.5;
        assert_eq!(toward_zero([-1.0, 0.0, 1.0].map(|x| [x, line(x)]), line), None);
    }
}
