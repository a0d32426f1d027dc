//! Numbers as bytes, in the shaders' scalar.

use crate::numerics::Real;
use bytemuck::Pod;

/// A scalar of the shaders.
pub trait Scalar: Real + Pod + Into<f64> {}

impl<T: Real + Pod + Into<f64>> Scalar for T {}

pub fn bytes<P: Pod>(things: impl ExactSizeIterator<Item = P>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(things.len() * size_of::<P>());
    for thing in things {
        bytes.extend_from_slice(bytemuck::bytes_of(&thing));
    }
    bytes
}

/// A number, and what the shaders' scalar leaves of it.
pub fn halves<T: Scalar>(number: f64) -> [T; 2] {
    let high = T::of(number);
    [high, T::of(number - high.into())]
}
