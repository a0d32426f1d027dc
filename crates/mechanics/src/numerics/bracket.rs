//! Roots of functions of one variable. A bracket holds two arguments at which the function has opposite signs.
//!
//! [`Bracket::newton`] is the root finder: Newton's method, Halley's or any other that proposes a next place, safeguarded by
//! bisection. [`Bracket::bisect`] needs values alone, [`Bracket::multisect`] signs alone. [`illinois`] is regula falsi, for
//! functions without slopes whose values are expensive. Searches whose values come in batches hold one bracket each and call
//! [`Bracket::shrink`].

/// Largest number of iterations: more than bisection needs between any two numbers of ordinary size.
const MOST_ITERATIONS: usize = 200;

/// Two arguments between which a function changes its sign. Either may be the smaller number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bracket {
    /// Argument at which the function is negative, in the unit of the search.
    pub below: f64,
    /// Argument at which the function is not negative, or NaN, in the unit of the search.
    pub above: f64,
}

/// Result of a root search: the root, the last step and the number of evaluations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Argument of the root, in the unit of the bracket.
    pub x: f64,
    /// Last step of the search toward the root, in the unit of the bracket.
    pub step: f64,
    /// Number of evaluations of the function during the search.
    pub iterations: usize,
}

impl Bracket {
    /// Creates the bracket of two arguments. The argument with the smaller of the two `values` becomes [`Bracket::below`].
    #[must_use]
    pub fn new([a, b]: [f64; 2], values: [f64; 2]) -> Self {
        let [below, above] = if values[0] <= values[1] { [a, b] } else { [b, a] };
        Self { below, above }
    }

    /// Returns the argument half way between the ends of the bracket, in the unit of the search.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * (self.below + self.above)
    }

    /// Returns true if `x` lies between the ends of the bracket or is one of them.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        (x - self.below) * (x - self.above) <= 0.0
    }

    /// Returns true if `x` lies between the ends of the bracket and is neither of them.
    #[must_use]
    pub fn is_inside(&self, x: f64) -> bool {
        (x - self.below) * (x - self.above) < 0.0
    }

    /// Moves one end of the bracket to `x`, where the function has this `value`. A NaN value counts as positive.
    pub fn shrink(&mut self, x: f64, value: f64) {
        if value < 0.0 {
            self.below = x;
        } else {
            self.above = x;
        }
    }

    /// Moves one end of the bracket to `x` as [`Bracket::shrink`] does. Returns the next argument to evaluate: `proposed` if the bracket
    /// contains it, otherwise the middle.
    fn next(&mut self, x: f64, value: f64, proposed: f64) -> f64 {
        self.shrink(x, value);
        if self.is_inside(proposed) { proposed } else { self.middle() }
    }

    /// Returns the root of the function `value` in the bracket by bisection, to the last digit, in the unit of the search.
    pub fn bisect(self, mut value: impl FnMut(f64) -> f64) -> f64 {
        let iterate = |x| (value(x), f64::NAN);
        self.newton(self.middle(), |_| 0.0, iterate).x
    }

    /// Divides the bracket in place until its ends are at most `width` apart or neighbouring numbers. Each round divides it by up to `most` points.
    /// `count_below(points)` returns the number of leading points, from [`Bracket::below`] on, at which the function is negative. Its first error
    /// ends the search and is returned. It serves where a function is known by its sign alone. Many points pay where their values take about as long
    /// as one value.
    ///
    /// # Errors
    ///
    /// The error of `count_below`.
    pub fn multisect<E>(
        &mut self,
        width: f64,
        most: usize,
        mut count_below: impl FnMut(&[f64]) -> Result<usize, E>,
    ) -> Result<(), E> {
        while (self.above - self.below).abs() > width {
            let step = (self.above - self.below) / (most + 1) as f64;
            let points = (1..=most).map(|i| step.mul_add(i as f64, self.below));
            let mut points: Vec<f64> = points.filter(|x| self.is_inside(*x)).collect();
            points.dedup();
            if points.is_empty() {
                break;
            }
            let count = count_below(&points)?;
            self.below = points[..count].last().copied().unwrap_or(self.below);
            self.above = points.get(count).copied().unwrap_or(self.above);
        }
        Ok(())
    }

    /// Returns the root by Newton's method, or by another method of its kind, from `start`. `iterate` returns the value at an argument
    /// and proposes the next one. The iteration ends with a proposed step inside the bracket of at most `last_step(x)`, where `x` is the
    /// argument at which the step begins.
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
            let next = if proposed == x { x } else { self.next(x, value, proposed) };
            let step = next - x;
            let is_last = next == proposed && step.abs() <= last_step(x);
            if is_last || next == x || iterations == MOST_ITERATIONS {
                return Root { x: next, step, iterations };
            }
            x = next;
        }
    }
}

/// Returns the root by regula falsi with the Illinois weights, without slopes: it also finds a root that is an extremum. The two ends are
/// `[argument, value]`. The iteration ends at a value of at most `tolerance`. Returns `None` if `value` does.
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
            return Some(Root { x, step: x - last[0], iterations });
        }
        if (here < 0.0) == (last[1] < 0.0) {
            // An end that is kept twice counts half; otherwise it would never move.
            kept[1] *= 0.5;
        } else {
            kept = last;
        }
        last = [x, here];
    }
}
