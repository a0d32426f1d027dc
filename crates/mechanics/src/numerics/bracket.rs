//! Roots of one variable. Newton's method and regula falsi are fast, but may leave for anywhere: two places at which the
//! function has opposite signs keep them in.

/// Most iterations: more than bisection needs between any two numbers of ordinary size.
const MOST_ITERATIONS: usize = 200;

/// Two places between which a function changes its sign; either may be the smaller number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bracket {
    /// Where the function is negative.
    pub below: f64,
    /// Where it is not, or not known.
    pub above: f64,
}

/// Where an iteration has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// The place.
    pub x: f64,
    /// The last step toward it.
    pub step: f64,
    /// How often the function was evaluated.
    pub iterations: usize,
}

impl Bracket {
    /// From two places, of which the one with the smaller of the `values` is below.
    #[must_use]
    pub fn new([a, b]: [f64; 2], values: [f64; 2]) -> Self {
        let [below, above] = if values[0] <= values[1] {
            [a, b]
        } else {
            [b, a]
        };
        Self { below, above }
    }

    /// Half way between the ends.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * (self.below + self.above)
    }

    /// Whether `x` is between the ends, or one of them.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        (x - self.below) * (x - self.above) <= 0.0
    }

    /// Whether `x` is between the ends, and neither of them.
    #[must_use]
    pub fn is_inside(&self, x: f64) -> bool {
        (x - self.below) * (x - self.above) < 0.0
    }

    /// Moves an end to `x`, where the function has this `value`.
    pub fn shrink(&mut self, x: f64, value: f64) {
        if value < 0.0 {
            self.below = x;
        } else {
            self.above = x;
        }
    }

    /// The same, and the next place to look at: the `proposed` one if it is inside, else the middle.
    pub fn next(&mut self, x: f64, value: f64, proposed: f64) -> f64 {
        self.shrink(x, value);
        if self.is_inside(proposed) {
            proposed
        } else {
            self.middle()
        }
    }

    /// Newton's method, or one of its kind, from `start`. `iterate` tells the value at a place, and which place it proposes
    /// next. A proposed step inside the bracket, no longer than `last_step` allows where it begins, is the last one.
    pub fn newton(
        mut self,
        start: f64,
        last_step: impl Fn(f64) -> f64,
        mut iterate: impl FnMut(f64) -> (f64, f64),
    ) -> Root {
        let mut x = start;
        let mut iterations = 0;
        loop {
            let (value, proposed) = iterate(x);
            iterations += 1;
            let next = if proposed == x {
                x
            } else {
                self.next(x, value, proposed)
            };
            let step = next - x;
            let is_last = next == proposed && step.abs() <= last_step(x);
            if is_last || next == x || iterations == MOST_ITERATIONS {
                return Root {
                    x: next,
                    step,
                    iterations,
                };
            }
            x = next;
        }
    }
}

/// Regula falsi with the Illinois weights: no slope is asked for, so a root that is also an extremum does no harm. The two `ends`
/// are places with their values. It ends at a value of at most `tolerance`; `None` where `value` fails.
pub fn illinois(
    [mut kept, mut last]: [[f64; 2]; 2],
    tolerance: f64,
    mut value: impl FnMut(f64) -> Option<f64>,
) -> Option<Root> {
    let mut iterations = 0;
    loop {
        let x = (kept[0] * last[1] - last[0] * kept[1]) / (last[1] - kept[1]);
        let here = value(x)?;
        iterations += 1;
        let is_stuck = x == kept[0] || x == last[0] || iterations == MOST_ITERATIONS;
        if here.abs() <= tolerance || is_stuck {
            return Some(Root {
                x,
                step: x - last[0],
                iterations,
            });
        }
        if (here < 0.0) == (last[1] < 0.0) {
            // The end that is kept once more counts half, or it would be kept for ever.
            kept[1] *= 0.5;
        } else {
            kept = last;
        }
        last = [x, here];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Bracket = Bracket {
        below: 0.0,
        above: 1.0,
    };

    /// Newton's method for `f`, which tells value and slope.
    fn newton(bracket: Bracket, start: f64, f: impl Fn(f64) -> (f64, f64)) -> Root {
        bracket.newton(
            start,
            |_| 1e-8,
            |x| {
                let (value, slope) = f(x);
                (value, x - value / slope)
            },
        )
    }

    #[test]
    fn newton_doubles_its_digits() {
        for turned in [1.0, -1.0] {
            let bracket = Bracket::new([0.0, 2.0], [-turned, turned]);
            let root = newton(bracket, 1.0, |x| (turned * (x * x - 2.0), turned * 2.0 * x));
            assert!((root.x - 2f64.sqrt()).abs() < 4.0 * f64::EPSILON);
            assert!(root.step.abs() < 1e-8 && root.iterations == 5, "{root:?}");
        }
    }

    #[test]
    fn halley_triples_its_digits() {
        let root = Bracket::new([0.0, 2.0], [-2.0, 2.0]).newton(
            1.0,
            |x| 1e-5 * x,
            |x| {
                let miss = x * x - 2.0;
                (miss, x - 2.0 * x * miss / (3.0 * x * x + 2.0))
            },
        );
        assert!((root.x - 2f64.sqrt()).abs() < 4.0 * f64::EPSILON);
        assert_eq!(root.iterations, 3);
    }

    /// Newton's method for the arcus tangent diverges from places beyond 1.39.
    #[test]
    fn a_step_out_of_the_bracket_goes_to_its_middle() {
        let bracket = Bracket::new([-70.0, 100.0], [-1.0, 1.0]);
        let root = newton(bracket, 90.0, |x| (x.atan(), 1.0 / (1.0 + x * x)));
        assert!(root.x.abs() < 1e-15 && root.iterations < 15, "{root:?}");
    }

    #[test]
    fn a_triple_root_is_found_slowly() {
        let root = newton(UNIT, 1.0, |x| ((x - 0.3).powi(3), 3.0 * (x - 0.3).powi(2)));
        assert!(
            (root.x - 0.3).abs() < 3e-8 && root.iterations < 50,
            "{root:?}"
        );
    }

    /// Without a change of sign there is an extremum, which the steps lead to.
    #[test]
    fn a_double_root_is_no_trap() {
        let root = newton(UNIT, 1.0, |x| ((x - 0.3).powi(2), 2.0 * (x - 0.3)));
        assert!(
            (root.x - 0.3).abs() < 3e-8 && root.iterations < 40,
            "{root:?}"
        );
    }

    /// Nothing is proposed on a flat slope or where there is no number: bisection goes on alone.
    #[test]
    fn without_slopes_it_bisects() {
        for slope in [0.0, f64::NAN, f64::INFINITY] {
            let value = |x: f64| x - 0.3;
            let root = newton(UNIT, 1.0, |x| {
                (value(x), if slope.is_infinite() { -1e-9 } else { slope })
            });
            assert!((root.x - 0.3).abs() <= f64::EPSILON, "{slope} {root:?}");
            assert!((50..60).contains(&root.iterations), "{slope} {root:?}");
        }
    }

    #[test]
    fn what_is_not_known_counts_as_above() {
        let sqrt = |x: f64| ((0.3 - x).sqrt() - 0.5, -0.5 / (0.3 - x).sqrt());
        let bracket = Bracket {
            below: 1.0,
            above: 0.0,
        };
        let root = newton(bracket, 0.9, sqrt);
        assert!(root.x.is_finite() && root.iterations < 70, "{root:?}");
        let nowhere = newton(UNIT, 0.5, |_| (f64::NAN, f64::NAN));
        assert!((0.0..1.0).contains(&nowhere.x), "{nowhere:?}");
    }

    #[test]
    fn a_root_at_an_end_is_found() {
        for (end, start) in [(0.0, 0.5), (1.0, 0.5), (0.0, 0.0), (1.0, 1.0)] {
            let root = newton(UNIT, start, |x| {
                let x = x - end;
                (x.exp_m1(), x.exp())
            });
            assert!((root.x - end).abs() < 1e-15, "{end} {root:?}");
        }
    }

    /// Steps that rounding makes as long as the last step allows, but to and fro.
    #[test]
    fn rounding_is_an_end() {
        let root = UNIT.newton(
            0.9,
            |_| 0.0,
            |x| {
                let value = (1e6 + x * x) - (1e6 + 0.09);
                (value, x - value / (2.0 * x))
            },
        );
        assert!(
            (root.x - 0.3).abs() < 1e-9 && root.iterations < 60,
            "{root:?}"
        );
    }

    #[test]
    fn illinois_needs_few_values() {
        let f = |x: f64| Some((0.4 * x).exp() - 1.1);
        let ends =
            |f: &dyn Fn(f64) -> Option<f64>| [0.0, 1.0].map(|x| [x, f(x).unwrap_or(f64::NAN)]);
        let root = illinois(ends(&f), 1e-16, f);
        assert!(
            root.is_some_and(|root| {
                (root.x - 1.1f64.ln() / 0.4).abs() < 4.0 * f64::EPSILON && root.iterations <= 8
            }),
            "{root:?}"
        );
        // Next to an extremum at the end, where regula falsi alone needs thousands.
        for below in [1e-1, 1e-2, 1e-3, 1e-4] {
            let f = |x: f64| Some(below - (1.0 - x).powi(2));
            let root = illinois(ends(&f), 1e-16, f);
            assert!(
                root.is_some_and(|root| {
                    (1.0 - root.x - below.sqrt()).abs() < 1e-12 && root.iterations <= 14
                }),
                "{below} {root:?}"
            );
        }
        assert_eq!(illinois(ends(&f), 1e-16, |_| None), None);
        assert!(
            illinois([[0.0, -1.0], [1.0, 0.0]], 0.0, |x| Some(x - 1.0))
                .is_some_and(|root| root.x == 1.0)
        );
    }
}
