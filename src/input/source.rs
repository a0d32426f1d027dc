//! Bytes of an input file, and the text that they encode.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Longest scene or measurement of a benchmark in MiB: far longer than any.
pub(crate) const TEXT_MIB: u64 = 1;

/// Longest table in MiB: a million samples of a course take 24.
pub(super) const TABLE_MIB: u64 = 32;

/// Opens the regular file at `path` to read it; `None` for a folder, a pipe or a device. The whole file is read from this handle, because
/// another process may replace the file meanwhile.
///
/// # Errors
/// If it cannot be opened.
pub(crate) fn open_regular(path: &Path) -> io::Result<Option<File>> {
    let mut options = File::options();
    options.read(true);
    // A pipe without a writer would block forever.
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags((OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed());
    }
    match options.open(path) {
        Ok(file) => Ok(file.metadata()?.is_file().then_some(file)),
        // Unix opens no socket, and Windows no folder.
        Err(_) if fs::metadata(path).is_ok_and(|about| !about.is_file()) => Ok(None),
        Err(why) => Err(why),
    }
}

/// Opens an input file.
///
/// # Errors
/// If it cannot be opened. That a path is a folder is an error here or of the first read.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    // Windows opens no folder, and calls that a lack of permission.
    if cfg!(windows) && path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    File::open(path)
}

/// Reads all bytes of an input file or stream, at most `most_mib` MiB.
///
/// # Errors
/// If it cannot be read, or is longer.
pub(crate) fn bounded(source: impl Read, most_mib: u64) -> io::Result<Vec<u8>> {
    let most = most_mib << 20;
    let mut bytes = Vec::new();
    source.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let what = format!("longer than {most_mib} MiB");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, what));
    }
    Ok(bytes)
}

/// Reads all bytes of the file at `path`, at most `most_mib` MiB; `-` is standard input.
///
/// # Errors
/// If it cannot be read, or is longer.
pub(crate) fn read(path: &Path, most_mib: u64) -> io::Result<Vec<u8>> {
    match path == Path::new("-") {
        true => bounded(io::stdin().lock(), most_mib),
        false => bounded(open(path)?, most_mib),
    }
}

/// Decodes the text of `bytes`, without a byte order mark: UTF-16 where the mark says so, UTF-8 otherwise.
///
/// # Errors
/// The line of the first wrong byte, from 1, and a message about it.
pub(super) fn decoded(bytes: &[u8]) -> Result<String, (usize, String)> {
    let (units, encoding): (fn([u8; 2]) -> u16, _) = match bytes {
        [0xFF, 0xFE, ..] => (u16::from_le_bytes, "UTF-16LE"),
        [0xFE, 0xFF, ..] => (u16::from_be_bytes, "UTF-16BE"),
        _ => return utf8(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)),
    };
    let (pairs, rest) = bytes[2..].as_chunks::<2>();
    let mut text = String::with_capacity(pairs.len());
    for unit in char::decode_utf16(pairs.iter().map(|pair| units(*pair))) {
        let wrong = |why: std::char::DecodeUtf16Error| {
            let unit = why.unpaired_surrogate();
            (line(&text), format!("not {encoding} text: code 0x{unit:04X}"))
        };
        let unit = unit.map_err(wrong)?;
        text.push(unit);
    }
    match rest {
        [] => Ok(text),
        _ => Err((line(&text), format!("not {encoding} text: half a character at the end"))),
    }
}

fn utf8(bytes: &[u8]) -> Result<String, (usize, String)> {
    let text = str::from_utf8(bytes).map_err(|why| {
        let (before, wrong) = bytes.split_at(why.valid_up_to());
        let before = String::from_utf8_lossy(before);
        (line(&before), format!("not UTF-8 text: byte 0x{:02X}", wrong[0]))
    })?;
    Ok(text.to_owned())
}

/// The line of the end of `text`, from 1; a carriage return alone ends a line, too.
fn line(text: &str) -> usize {
    1 + text.replace("\r\n", "\n").matches(['\n', '\r']).count()
}
