//! Golden section: the minimum of a function of one variable between two arguments, without slopes.

/// Steps of the golden section. They leave 1e-8 of the interval, in which a smooth function is flat to rounding.
const STEPS: u32 = 40;

/// Part of an interval that a step of the golden section keeps.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Returns `[argument, value]` of the least value found between the two `ends`. A value below `enough` ends the search. The search avoids NaN; it
/// returns NaN only if every value is.
pub fn least_between(
    mut ends: [f64; 2],
    enough: f64,
    mut value: impl FnMut(f64) -> f64,
) -> [f64; 2] {
    let [mut low, mut high] = [GOLDEN, 1.0 - GOLDEN].map(|part| {
        let at = part * ends[0] + (1.0 - part) * ends[1];
        [at, value(at)]
    });
    let mut best = [low[0], f64::NAN];
    for _ in 0..STEPS {
        for inner in [low, high] {
            if inner[1] < best[1] || best[1].is_nan() {
                best = inner;
            }
        }
        if best[1] < enough {
            break;
        }
        if low[1] < high[1] || high[1].is_nan() {
            (ends[1], high) = (high[0], low);
            let at = GOLDEN * ends[0] + (1.0 - GOLDEN) * ends[1];
            low = [at, value(at)];
        } else {
            (ends[0], low) = (low[0], high);
            let at = (1.0 - GOLDEN) * ends[0] + GOLDEN * ends[1];
            high = [at, value(at)];
        }
    }
    best
}
