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

    /// Bisection, to the last digit.
    pub fn bisect(self, mut value: impl FnMut(f64) -> f64) -> f64 {
        let iterate = |x| (value(x), f64::NAN);
        self.newton(self.middle(), |_| 0.0, iterate).x
    }

    /// Halves the bracket until its ends are at most `width` apart or neighbouring numbers. `is_below` decides which end
    /// moves to the middle; its first error ends the search and is returned. It serves where a function is known by its
    /// sign alone.
    ///
    /// # Errors
    ///
    /// The error of `is_below`.
    pub fn halve<E>(
        &mut self,
        width: f64,
        mut is_below: impl FnMut(f64) -> Result<bool, E>,
    ) -> Result<(), E> {
        while (self.above - self.below).abs() > width && self.is_inside(self.middle()) {
            let middle = self.middle();
            if is_below(middle)? {
                self.below = middle;
            } else {
                self.above = middle;
            }
        }
        Ok(())
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
