//! Output of one channel of a slice as a NumPy array.

use super::super::failure::Failure;
use super::super::files::{Files, unwritten};
use super::refuse;
use std::io::{BufWriter, IntoInnerError, Write};
use std::path::Path;
use whiskmap::store::{ChannelValues, MapSlice, Output};

/// Writes the only channel of `channels` of a slice as a NumPy array.
pub fn array(
    slice: &MapSlice,
    channels: &[&'static str],
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    let [channel] = channels else {
        return refuse(path, "an array has one channel; give one --channel");
    };
    let mut file = BufWriter::new(files.output("--output", path)?);
    for (number, whisker) in slice.whiskers().enumerate() {
        let (kind, bytes): (_, Vec<u8>) = match slice.read_panel(channel, whisker)? {
            ChannelValues::F32(values) => {
                ("<f4", values.into_iter().flat_map(f32::to_le_bytes).collect())
            }
            ChannelValues::U32(codes) => {
                ("<u4", codes.into_iter().flat_map(u32::to_le_bytes).collect())
            }
        };
        let header = if number == 0 { npy(kind, &slice.shape()) } else { Vec::new() };
        let written = file.write_all(&header).and_then(|()| file.write_all(&bytes));
        written.map_err(unwritten(path))?;
    }
    let output = file.into_inner().map_err(IntoInnerError::into_error);
    let done = output.and_then(Output::finish);
    done.map(drop).map_err(unwritten(path))
}

/// Returns the header of a NumPy file, version 1.0.
fn npy(kind: &str, shape: &[usize]) -> Vec<u8> {
    let sizes: String = shape.iter().map(|size| format!("{size},")).collect();
    let about = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({sizes}), }}");
    // The values begin at a multiple of 64 bytes, after a line break.
    let length = (about.len() + 11).next_multiple_of(64) - 10;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((length as u16).to_le_bytes());
    header.extend(format!("{about:<width$}\n", width = length - 1).into_bytes());
    header
}
