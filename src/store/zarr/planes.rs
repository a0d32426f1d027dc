//! The order of the bytes of a chunk: lines as columns, rounded values, and planes of equal significance.

use crate::plan::rounded;

/// Number of columns that are turned together: the columns of a cache line.
const TOGETHER: usize = 16;

/// Values that are separated together, in a cache.
const STRIP: usize = 1 << 12;

/// The first bytes of all `values` of 4 bytes, then the second ones, and so on. Lines of `width` values become columns; quantities are
/// rounded to `kept_bits` of mantissa.
pub(super) fn planes(values: &[u8], width: Option<usize>, kept_bits: Option<u32>) -> Vec<u8> {
    let (values, _) = values.as_chunks::<4>();
    let mut planes = vec![0; values.as_flattened().len()];
    let mut separate = |first: usize, strip: &mut [u32]| {
        if let Some(bits) = kept_bits {
            for value in &mut *strip {
                *value = rounded(f32::from_bits(*value), bits).to_bits();
            }
        }
        for (place, plane) in planes.chunks_exact_mut(values.len()).enumerate() {
            let plane = plane[first..].iter_mut().zip(&*strip);
            plane.for_each(|(to, value)| *to = (value >> (8 * place)) as u8);
        }
    };
    let Some(width) = width else {
        let mut strip = Vec::with_capacity(STRIP);
        for (number, part) in values.chunks(STRIP).enumerate() {
            strip.clear();
            strip.extend(part.iter().copied().map(u32::from_le_bytes));
            separate(number * STRIP, &mut strip);
        }
        return planes;
    };
    let height = values.len() / width;
    let mut strip = vec![0; height * TOGETHER];
    for first in (0..width).step_by(TOGETHER) {
        let columns = TOGETHER.min(width - first);
        for (y, line) in values.chunks_exact(width).enumerate() {
            for (x, value) in line[first..first + columns].iter().enumerate() {
                strip[x * height + y] = u32::from_le_bytes(*value);
            }
        }
        separate(first * height, &mut strip[..columns * height]);
    }
    planes
}

/// The values of `size` bytes of these `planes`, in the order of the planes.
pub(super) fn joined(planes: &[u8], size: usize, values: &mut [u8]) {
    for (place, plane) in planes.chunks_exact(values.len() / size).enumerate() {
        let bytes = values[place..].iter_mut().step_by(size);
        bytes.zip(plane).for_each(|(to, from)| *to = *from);
    }
}

/// Lines of `width` values of 4 bytes, turned into columns.
pub(super) fn turned(lines: &[u8], width: usize) -> Vec<u8> {
    let (from, _) = lines.as_chunks::<4>();
    let mut turned = vec![0; lines.len()];
    let (to, _) = turned.as_chunks_mut::<4>();
    let height = from.len() / width;
    for first in (0..width).step_by(TOGETHER) {
        for (y, line) in from.chunks_exact(width).enumerate() {
            let columns = line.iter().enumerate().skip(first).take(TOGETHER);
            for (x, value) in columns {
                to[x * height + y] = *value;
            }
        }
    }
    turned
}
