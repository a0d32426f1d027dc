//! Extremum of a function near zero, between samples. The function has no sign change to bracket, so the golden section brackets its
//! extremum by three values.

/// Steps of the golden section. They leave 1e-8 of the interval, in which a smooth function is flat to rounding.
const STEPS: u32 = 40;

/// Part of an interval that a step of the golden section keeps.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Returns argument and value of an extremum toward zero between three neighbouring arguments with their values, or the first argument
/// found beyond zero. `None` without such an extremum, or if it is too far from zero for a smooth function.
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
    let mut best = here;
    let mut ends = [before[0], after[0]];
    let [mut low, mut high] = [GOLDEN, 1.0 - GOLDEN].map(|part| {
        let at = part * ends[0] + (1.0 - part) * ends[1];
        [at, sign * value(at)]
    });
    for _ in 0..STEPS {
        for [at, there] in [low, high] {
            if there < sign * best[1] {
                best = [at, sign * there];
            }
        }
        if sign * best[1] < 0.0 {
            break;
        }
        // The search avoids NaN.
        if low[1] < high[1] || high[1].is_nan() {
            (ends[1], high) = (high[0], low);
            let at = GOLDEN * ends[0] + (1.0 - GOLDEN) * ends[1];
            low = [at, sign * value(at)];
        } else {
            (ends[0], low) = (low[0], high);
            let at = (1.0 - GOLDEN) * ends[0] + GOLDEN * ends[1];
            high = [at, sign * value(at)];
        }
    }
    (best != here).then_some(best)
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
        assert_eq!(
            toward_zero([-1.0, 0.0, 1.0].map(|x| [x, line(x)]), line),
            None
        );
    }
}
