//! What is in the files of a block.

use super::ZarrStore;
use super::array::Array;
use super::kind::Kind;
use super::metadata::CELLS;
use crate::classify::Regime;
use crate::store::{Error, Samples};
use rayon::prelude::*;
use std::{fs, io};

impl ZarrStore {
    /// How many cells of a block there are of each regime.
    ///
    /// # Errors
    ///
    /// The block is not there, or damaged.
    pub fn regimes(&self, block: usize) -> Result<[u64; Regime::ALL.len()], Error> {
        let mut regimes = [0; Regime::ALL.len()];
        for array in self.arrays.iter().filter(|array| array.name == CELLS) {
            let values: Vec<u32> = bytemuck::pod_collect_to_vec(&self.read(array, block)?);
            for of_whisker in values.chunks(regimes.len()) {
                for (sum, cells) in regimes.iter_mut().zip(of_whisker) {
                    *sum += u64::from(*cells);
                }
            }
        }
        Ok(regimes)
    }

    /// Reads all of a block, and tells what is wrong with it.
    #[must_use]
    pub fn verify(&self, block: usize) -> Vec<Error> {
        let read = self.arrays.par_iter().map(|array| self.read(array, block));
        read.filter_map(Result::err).collect()
    }

    /// A channel of one whisker: `[distance][push angle]`.
    ///
    /// # Errors
    ///
    /// There is no such channel, or the whisker's block is missing or damaged.
    pub fn read_panel(&self, name: &str, whisker: usize) -> Result<Samples, Error> {
        let array = self
            .arrays
            .iter()
            .find(|array| array.name == name && name != CELLS);
        let array = array.ok_or_else(|| Error::UnknownChannel {
            path: self.path.clone(),
            name: name.to_owned(),
            known: self.channels.to_string(),
        })?;
        let (block, index) = self.blocks.find(whisker);
        let bytes = self.read(array, block)?;
        let (panel, room) = self.sizes(array);
        let first = self.blocks.slot(block, index) * room;
        let bytes = &bytes[first..first + panel];
        Ok(match array.kind {
            Kind::Code => Samples::U32(bytes.iter().map(|code| u32::from(*code)).collect()),
            Kind::Count => Samples::U32(bytemuck::pod_collect_to_vec(bytes)),
            _ => Samples::F32(bytemuck::pod_collect_to_vec(bytes)),
        })
    }

    fn read(&self, array: &Array, block: usize) -> Result<Vec<u8>, Error> {
        let file = self.file(array, block);
        let bytes = fs::read(&file).map_err(|why| match why.kind() {
            io::ErrorKind::NotFound => Error::NotComputed(file.clone()),
            _ => Error::Read(file.clone(), why),
        })?;
        let values = array
            .decode(bytes)
            .map_err(Error::at(&file, Error::Damaged))?;
        if values.len() == array.values() * array.kind.size() {
            Ok(values)
        } else {
            Err(Error::Damaged(file, "it has the wrong length".to_owned()))
        }
    }

    /// Bytes of a whisker's values in a block, and of the room there.
    fn sizes(&self, array: &Array) -> (usize, usize) {
        let room = array.values() / self.blocks.slots();
        let [distances, push_angles] = self.blocks.panel();
        let values = if array.name == CELLS {
            room
        } else {
            distances * push_angles
        };
        (values * array.kind.size(), room * array.kind.size())
    }
}
