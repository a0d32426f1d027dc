//! Header of an EXR map: all bytes before the blocks.

use super::StoreError;
use super::attributes::{CHECKSUM, ExrAttributes, NO_CHECKSUM};
use super::layout::AtlasLayout;
use super::stored::is_compatible;
use crate::plan::Channels;
use exr::io::PeekRead;
use exr::meta::attribute;
use exr::meta::header::Header;
use exr::meta::{MetaData, OffsetTables, magic_number, sequence_end};
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::ops::Range;
use std::path::Path;

/// Encodes the header of an EXR map: all bytes before the offset tables. Attributes are sorted by name, so that equal maps have equal
/// bytes.
pub(super) fn encode(headers: &[Header]) -> exr::error::Result<Vec<u8>> {
    let requirements = MetaData::validate(headers, true)?;
    let mut bytes = Vec::new();
    magic_number::write(&mut bytes)?;
    requirements.write(&mut bytes)?;
    for header in headers {
        let mut attributes: Vec<_> = header.all_named_attributes().collect();
        attributes.sort_unstable_by_key(|(name, _)| *name);
        for (name, value) in attributes {
            attribute::write(name, &value, &mut bytes)?;
        }
        sequence_end::write(&mut bytes)?;
    }
    // A list of headers has an end; a file of one part has no list.
    if headers.len() > 1 {
        sequence_end::write(&mut bytes)?;
    }
    Ok(bytes)
}

/// Reads the header of an EXR map and checks its checksum, but not its layout.
pub(super) fn read(path: &Path, file: &mut BufReader<File>) -> Result<MetaData, StoreError> {
    let mut magic = [0; 4];
    match file.read_exact(&mut magic) {
        Ok(()) if magic == magic_number::BYTES => {}
        Err(cause) if cause.kind() != io::ErrorKind::UnexpectedEof => {
            return Err(StoreError::Read(path.to_owned(), cause));
        }
        _ => return Err(StoreError::NotExr(path.to_owned())),
    }
    file.rewind().map_err(StoreError::at(path, StoreError::Read))?;
    let damaged = |why: String| StoreError::Damaged(path.to_owned(), format!("header: {why}"));
    let meta =
        MetaData::read_from_buffered(&mut *file, true).map_err(|why| damaged(why.to_string()))?;
    match has_checksum(file, &meta).map_err(StoreError::at(path, StoreError::Read))? {
        true => Ok(meta),
        false => Err(damaged("it does not have its checksum".to_owned())),
    }
}

/// Returns true if the bytes read so far have their checksum. Maps of incompatible versions and other files need none.
fn has_checksum(file: &mut BufReader<File>, meta: &MetaData) -> io::Result<bool> {
    let mut preamble = vec![0; file.stream_position()? as usize];
    file.rewind()?;
    file.read_exact(&mut preamble)?;
    let places = places_of_checksum(&preamble);
    if places.is_empty() {
        let version = parse::<String>(meta, "whiskmap_version");
        return Ok(!version.is_ok_and(|version| is_compatible(&version)));
    }
    let mut sealed = preamble.clone();
    for place in places {
        sealed[place].copy_from_slice(NO_CHECKSUM.as_bytes());
    }
    seal(&mut sealed);
    Ok(sealed == preamble)
}

/// Writes the checksum of the header of an EXR map into each part, in the place of [`NO_CHECKSUM`].
pub(super) fn seal(preamble: &mut [u8]) {
    let digits = format!("{:08x}", crc32c::crc32c(preamble));
    for place in places_of_checksum(preamble) {
        preamble[place].copy_from_slice(digits.as_bytes());
    }
}

/// Ranges of the checksum's digits, behind name, type and size of their attribute and a quotation mark.
fn places_of_checksum(preamble: &[u8]) -> Vec<Range<usize>> {
    let size = NO_CHECKSUM.len() + 2;
    let size = (size as u32).to_le_bytes();
    let before = [CHECKSUM.as_bytes(), b"\0string\0", &size, b"\""].concat();
    let windows = preamble.windows(before.len() + NO_CHECKSUM.len());
    let found = windows.enumerate().filter(|(_, bytes)| bytes.starts_with(&before));
    let places = found.map(|(first, bytes)| first + before.len()..first + bytes.len());
    places.collect()
}

/// Reads the offset tables of an EXR map, which are between the header and the blocks.
pub(super) fn read_offsets(
    path: &Path,
    file: &mut BufReader<File>,
    meta: &MetaData,
) -> Result<OffsetTables, StoreError> {
    MetaData::read_offset_tables(&mut PeekRead::new(file), &meta.headers)
        .map_err(|cause| StoreError::Damaged(path.to_owned(), format!("offset table: {cause}")))
}

/// Checks that parts, channels, size, tiles and compression of an EXR map are as this program writes `layout`.
pub(super) fn check_layout(
    meta: &MetaData,
    layout: AtlasLayout,
    channels: Channels,
) -> Result<(), String> {
    if parse::<[usize; 2]>(meta, "panels")? != [layout.columns, layout.rows] {
        return Err("attributes `panels` and `axes` differ".to_owned());
    }
    let mut found = meta.headers.clone();
    for header in &mut found {
        header.own_attributes.other.clear();
    }
    if found != layout.headers(channels, &ExrAttributes::new()) {
        return Err("the parts and channels are not those that the axes demand".to_owned());
    }
    Ok(())
}

/// Returns the channels of an EXR map.
pub(super) fn channels(meta: &MetaData) -> Channels {
    let lists = meta.headers.iter().map(|header| &header.channels.list);
    let found: Vec<_> = lists.flatten().map(|channel| &channel.name).collect();
    Channels::those(|name| found.iter().any(|channel| channel.bytes() == name.as_bytes()))
}

/// Decodes an attribute of the first part of an EXR map.
pub(super) fn parse<T: DeserializeOwned>(meta: &MetaData, name: &str) -> Result<T, String> {
    let attributes = meta.headers.first().map(|header| &header.own_attributes);
    let mut attributes = attributes.into_iter().flat_map(|attributes| &attributes.other);
    let text = attributes
        .find(|(found, _)| found.bytes() == name.as_bytes())
        .and_then(|(_, value)| str::from_utf8(value.to_text().ok()?.bytes()).ok())
        .ok_or_else(|| format!("there is no text attribute `{name}`"))?;
    serde_json::from_str(text).map_err(|error| format!("attribute `{name}`: {error}"))
}
