//! ZIP compression of EXR blocks, straight from the samples of a panel.
//!
//! OpenEXR (`ImfZip.cpp`): of all bytes of a block those at even places come first, then those at odd ones; each is replaced by its
//! difference from the one before it, plus 128; and all that is deflated (zlib, RFC 1950). A block that does not get smaller
//! is stored as it was.

use crate::plan::rounded;
use miniz_oxide::deflate::compress_to_vec_zlib;

/// The fastest level of `miniz_oxide`, at nearly the smallest size: see `benches/NOTES.md`.
const LEVEL: u8 = 1;

/// A line of samples of 4 bytes, and the number of mantissa bits to which they are rounded.
pub(super) type SampleLine<'a> = (&'a [u8], Option<u32>);

/// The block of these `lines` of samples, in the order of the file.
pub(super) fn pack<'a>(lines: impl Iterator<Item = SampleLine<'a>> + Clone) -> Vec<u8> {
    let mut bytes = separated(lines.clone());
    take_differences(&mut bytes);
    let packed = compress_to_vec_zlib(&bytes, LEVEL);
    if packed.len() < bytes.len() {
        return packed;
    }
    bytes.clear();
    for (line, kept_bits) in lines {
        let (samples, _) = line.as_chunks::<4>();
        let samples = samples.iter().map(|sample| stored(*sample, kept_bits));
        bytes.extend(samples.flat_map(u32::to_le_bytes));
    }
    bytes
}

/// The sample as it is stored.
fn stored(sample: [u8; 4], kept_bits: Option<u32>) -> u32 {
    let sample = u32::from_le_bytes(sample);
    kept_bits.map_or(sample, |bits| rounded(f32::from_bits(sample), bits).to_bits())
}

/// The bytes at even places, then those at odd ones; every line has as many of both.
fn separated<'a>(lines: impl Iterator<Item = SampleLine<'a>> + Clone) -> Vec<u8> {
    let size = lines.clone().map(|(line, _)| line.len()).sum();
    let mut separated = vec![0; size];
    let (mut evens, mut odds) = separated.split_at_mut(size / 2);
    for (line, kept_bits) in lines {
        let (samples, _) = line.as_chunks::<4>();
        let (even, odd);
        (even, evens) = evens.split_at_mut(line.len() / 2);
        (odd, odds) = odds.split_at_mut(line.len() / 2);
        let (even, odd) = (even.as_chunks_mut().0, odd.as_chunks_mut().0);
        for ((even, odd), sample) in even.iter_mut().zip(odd).zip(samples) {
            let bytes = stored(*sample, kept_bits).to_le_bytes();
            *even = [bytes[0], bytes[2]];
            *odd = [bytes[1], bytes[3]];
        }
    }
    separated
}

/// Bytes whose differences are taken together, by vectors.
const TOGETHER: usize = 64;

/// Puts the difference from the byte before, plus 128, in the place of every byte but the first.
fn take_differences(bytes: &mut [u8]) {
    let mut last = 128;
    for part in bytes.chunks_mut(TOGETHER) {
        let mut before = [last; TOGETHER];
        before[1..part.len()].copy_from_slice(&part[..part.len() - 1]);
        last = part[part.len() - 1];
        for (byte, before) in part.iter_mut().zip(before) {
            *byte = byte.wrapping_sub(before).wrapping_add(128);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::hash;
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    /// Lines of samples as a rule makes them.
    fn lines(samples: usize, sample: impl Fn(u32) -> u32) -> Vec<Vec<u8>> {
        let line = |y: u32| {
            let samples = (0..samples as u32).map(|x| sample(x + 200 * y));
            samples.flat_map(u32::to_le_bytes).collect()
        };
        (0..3).map(line).collect()
    }

    #[test]
    fn the_filter_is_that_of_openexr() {
        for samples in [9, 16, 123] {
            let lines = lines(samples, |x| ((x / 8) as f32).sqrt().to_bits());
            let bytes = lines.concat();
            let halves = [0, 1].map(|first| bytes.iter().skip(first).step_by(2));
            let mut expected: Vec<u8> = halves.into_iter().flatten().copied().collect();
            for i in (1..expected.len()).rev() {
                let difference = i32::from(expected[i]) - i32::from(expected[i - 1]) + 128;
                expected[i] = difference as u8;
            }
            let packed = pack(lines.iter().map(|line| (line.as_slice(), None)));
            assert!(packed.len() < bytes.len());
            assert_eq!(decompress_to_vec_zlib(&packed).ok(), Some(expected));
        }
    }

    fn noise(x: u32) -> u32 {
        hash(x.into()) as u32
    }

    #[test]
    fn noise_is_stored_as_it_is() {
        let lines = lines(50, noise);
        assert_eq!(pack(lines.iter().map(|line| (line.as_slice(), None))), lines.concat());
    }

    /// Readers take a block as long as its samples for one that is not compressed.
    #[test]
    fn a_block_that_stays_as_long_is_stored_as_it_is() {
        let mut equal = 0;
        for (samples, zeros) in
            (40..70).flat_map(|samples| (0..60).map(move |zeros| (samples, zeros)))
        {
            let lines = lines(samples, |x| if x % 200 < zeros { 0 } else { noise(x) });
            let lines = || lines.iter().map(|line| (line.as_slice(), None));
            let mut bytes = separated(lines());
            take_differences(&mut bytes);
            if compress_to_vec_zlib(&bytes, LEVEL).len() == bytes.len() {
                let bytes = lines().flat_map(|(line, _)| line).copied();
                assert!(pack(lines()).into_iter().eq(bytes));
                equal += 1;
            }
        }
        assert!(equal > 0);
    }
}
