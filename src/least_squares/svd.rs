//! Singular value decomposition of a small dense matrix.

/// Most sweeps over all pairs of columns. Convergence is quadratic, and takes about ten.
const SWEEPS: u32 = 30;

/// Largest cosine of orthogonal columns: the rounding of scalar products of a hundred components.
const ORTHOGONAL: f64 = 1e-14;

/// Singular value decomposition of a matrix `A`: directions `v` in the space of columns, with their images `A v`. Images are orthogonal
/// to each other.
pub struct Svd {
    /// Unit directions `v` in the space of columns: `[direction][column]`.
    pub directions: Vec<Vec<f64>>,
    /// Images `A v` of the directions `v` under the decomposed matrix: `[direction][row]`; the length of an image is a singular value.
    pub images: Vec<Vec<f64>>,
}

impl Svd {
    /// Decomposes the matrix with these columns, by one-sided Jacobi rotations (Hestenes 1958; Demmel, Applied Numerical Linear
    /// Algebra, 1997, algorithm 5.13). Small singular values are accurate relative to the lengths of their columns.
    pub fn new(mut images: Vec<Vec<f64>>) -> Self {
        let count = images.len();
        let unit = |i: usize| (0..count).map(move |j| f64::from(u8::from(i == j))).collect();
        let mut directions: Vec<Vec<f64>> = (0..count).map(unit).collect();
        for _ in 0..SWEEPS {
            let mut is_done = true;
            for (i, j) in (1..count).flat_map(|j| (0..j).map(move |i| (i, j))) {
                let [a, b, c] = [(i, i), (j, j), (i, j)].map(|(i, j)| dot(&images[i], &images[j]));
                if c == 0.0 || c.abs() <= ORTHOGONAL * (a * b).sqrt() {
                    continue;
                }
                is_done = false;
                let zeta = (b - a) / (2.0 * c);
                let tan = zeta.signum() / (zeta.abs() + libm::hypot(zeta, 1.0));
                let cos = 1.0 / libm::hypot(tan, 1.0);
                for columns in [&mut images, &mut directions] {
                    rotate(columns, [i, j], [cos, cos * tan]);
                }
            }
            if is_done {
                break;
            }
        }
        Self { directions, images }
    }

    /// Yields each singular value with its direction `[column]` and image `[row]`.
    pub fn values(&self) -> impl Iterator<Item = (f64, &[f64], &[f64])> {
        let pairs = self.directions.iter().zip(&self.images);
        pairs.map(|(direction, image)| (norm(image), direction.as_slice(), image.as_slice()))
    }

    /// Returns the largest singular value.
    pub fn largest(&self) -> f64 {
        self.values().fold(0.0, |most, (value, ..)| value.max(most))
    }
}

fn rotate(columns: &mut [Vec<f64>], [i, j]: [usize; 2], [cos, sin]: [f64; 2]) {
    let (low, high) = columns.split_at_mut(j);
    for (x, y) in low[i].iter_mut().zip(&mut high[0]) {
        (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
    }
}

/// Returns the scalar product of two vectors of the same length.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the Euclidean length of a vector.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Hilbert matrix of order 5: its condition number is 4.766e5.
    #[test]
    fn a_decomposition_is_orthogonal_and_exact() {
        let column = |j: usize| (0..5).map(move |i| 1.0 / (i + j + 1) as f64).collect();
        let matrix: Vec<Vec<f64>> = (0..5).map(column).collect();
        let svd = Svd::new(matrix.clone());
        let values: Vec<f64> = svd.values().map(|(value, ..)| value).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((svd.largest() / least / 4.766_072_502e5 - 1.0).abs() < 1e-9);
        for (i, (value, direction, image)) in svd.values().enumerate() {
            for (j, (_, other, other_image)) in svd.values().enumerate() {
                let same = f64::from(u8::from(i == j));
                assert!((dot(direction, other) - same).abs() < 1e-14);
                assert!(dot(image, other_image).abs() < 1e-14 + same * value * value * 1.01);
            }
            for (row, component) in image.iter().enumerate() {
                let product: f64 = (0..5).map(|j| matrix[j][row] * direction[j]).sum();
                assert!((product - component).abs() < 1e-15);
            }
        }
    }
}
