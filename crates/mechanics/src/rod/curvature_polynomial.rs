//! Curvature at rest as a polynomial of the arclength, such as the curvature of a shape traced from an image.

/// Number of coefficients of a [`CurvaturePolynomial`]: one more than its largest degree.
pub const CURVATURE_TERMS: usize = 7;

/// Number of places at which the largest curvature is searched.
const PLACES: u32 = 512;

/// Curvature of a whisker at rest, in radians per whisker length, as a polynomial of the arclength.
///
/// Coefficients belong to Legendre polynomials of `2 s - 1`, with the arclength `s` in whisker lengths: the first one is the angle
/// by which the whole whisker turns, in radians. Powers of `s` would cancel in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvaturePolynomial {
    legendre: [f64; CURVATURE_TERMS],
    centred: [f64; CURVATURE_TERMS],
    sharpest: f64,
}

impl CurvaturePolynomial {
    /// Creates the polynomial with these coefficients of Legendre polynomials, `[degree]`, in radians per whisker length.
    #[must_use]
    pub fn new(legendre: [f64; CURVATURE_TERMS]) -> Self {
        let mut polynomial = Self { legendre, centred: centred(&legendre), sharpest: 0.0 };
        let places = (0..=PLACES).map(|i| polynomial.at(f64::from(i) / f64::from(PLACES)).abs());
        polynomial.sharpest = places.fold(0.0, f64::max);
        polynomial
    }

    /// Returns the coefficients of the Legendre polynomials of `2 s - 1`, `[degree]`, in radians per whisker length.
    #[must_use]
    pub const fn legendre(&self) -> &[f64; CURVATURE_TERMS] {
        &self.legendre
    }

    /// Returns the coefficients of the powers of `s - 1/2`, `[power]`, in radians per whisker length to this power and one more.
    #[must_use]
    pub const fn centred(&self) -> &[f64; CURVATURE_TERMS] {
        &self.centred
    }

    /// Returns the largest curvature between base and tip, in radians per whisker length.
    #[must_use]
    pub const fn sharpest(&self) -> f64 {
        self.sharpest
    }

    /// Returns the curvature at arclength `s` (whisker lengths), in radians per whisker length.
    #[must_use]
    pub fn at(&self, s: f64) -> f64 {
        let x = s - 0.5;
        let terms = self.centred.iter().rev();
        terms.fold(0.0, |sum, term| sum.mul_add(x, *term))
    }

    /// Taylor terms `[power]` of the curvature around arclength `s` (whisker lengths), by repeated synthetic division.
    pub(super) fn around(&self, s: f64) -> [f64; CURVATURE_TERMS] {
        let (x, mut terms) = (s - 0.5, self.centred);
        for least in 0..CURVATURE_TERMS - 1 {
            for power in (least..CURVATURE_TERMS - 1).rev() {
                terms[power] += x * terms[power + 1];
            }
        }
        terms
    }

    /// Returns the angle of the tangent at arclength `s` (whisker lengths) from the base's tangent, in radians.
    #[must_use]
    pub fn angle(&self, s: f64) -> f64 {
        // The divided difference of the antiderivative between `s` and the base.
        let (x, base) = (s - 0.5, -0.5);
        let [mut value, mut divided] = [0.0_f64; 2];
        for (power, term) in self.centred.iter().enumerate().rev() {
            divided = divided.mul_add(base, value);
            value = value.mul_add(x, term / (power + 1) as f64);
        }
        s * divided.mul_add(base, value)
    }
}

/// Coefficients of the powers of `s - 1/2` of a sum of Legendre polynomials of `2 s - 1`. With `x = s - 1/2`, Bonnet's recursion is
/// `(n + 1) P_(n+1) = (2 n + 1) 2 x P_n - n P_(n-1)`.
fn centred(legendre: &[f64; CURVATURE_TERMS]) -> [f64; CURVATURE_TERMS] {
    let mut sum = [0.0; CURVATURE_TERMS];
    let mut before = [0.0; CURVATURE_TERMS];
    let mut current = [0.0; CURVATURE_TERMS];
    current[0] = 1.0;
    for (n, coefficient) in legendre.iter().enumerate() {
        for (sum, term) in sum.iter_mut().zip(current) {
            *sum += coefficient * term;
        }
        let order = n as f64;
        let mut next = [0.0; CURVATURE_TERMS];
        for power in 0..CURVATURE_TERMS {
            let shifted = if power > 0 { current[power - 1] } else { 0.0 };
            next[power] = ((4.0 * order + 2.0) * shifted - order * before[power]) / (order + 1.0);
        }
        (before, current) = (current, next);
    }
    sum
}
