//! The zip archive of a workbook, and what may be read and kept of it.

use std::collections::HashMap;
use std::io::{BufReader, Read};

use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};
use slipfront_base::text::truncated;
use slipfront_case::xml::{self, Piece};

/// Largest size of a workbook, and of all XML in it that is read, bytes.
pub(in crate::measured) const MOST_BYTES: u64 = 1 << 28;
/// Largest size of all text that is kept of a workbook, bytes: some four million numbers.
const TEXT_MAX_BYTES: usize = 1 << 26;
/// Largest number of cells, texts and formats of a workbook.
const ITEMS_MAX: usize = 1 << 22;
/// Largest number of nodes and attributes of all XML that is read: a number takes about six.
const NODES_MAX: usize = 3 << 22;
/// Largest number of files in the archive.
const PARTS_MAX: usize = 1 << 16;
/// Bytes that are counted for a sheet or a link besides its text: at least those that they take in memory.
pub(super) const NAMED_BYTES: usize = 256;

/// Numbers of cells and bytes that may still be kept of a workbook.
pub(super) struct Budget {
    items: usize,
    bytes: usize,
}

impl Budget {
    /// The budget of a workbook of which nothing was read.
    pub(super) fn new() -> Self {
        Self {
            items: ITEMS_MAX,
            bytes: TEXT_MAX_BYTES,
        }
    }

    /// Refuses a text of more bytes than may still be kept.
    pub(super) fn holds(&self, bytes: usize) -> Result<(), String> {
        match bytes > self.bytes {
            true => Err(too_large("text", TEXT_MAX_BYTES as u64)),
            false => Ok(()),
        }
    }

    /// Counts cells, texts or formats, and bytes of text that are kept.
    pub(super) fn take(&mut self, items: usize, bytes: usize) -> Result<(), String> {
        let too_many = || format!("it has more than {ITEMS_MAX} cells, texts and formats");
        self.items = self.items.checked_sub(items).ok_or_else(too_many)?;
        let left = self.bytes.checked_sub(bytes);
        self.bytes = left.ok_or_else(|| too_large("text", TEXT_MAX_BYTES as u64))?;
        Ok(())
    }
}

fn too_large(what: &str, most: u64) -> String {
    format!("it has more than {} MiB of {what}", most >> 20)
}

/// The files of an archive.
pub(super) struct Parts<'b> {
    archive: ZipSliceArchive<&'b [u8]>,
    /// How each file is compressed, and where it is; none once it was read.
    entries: HashMap<String, Option<(CompressionMethod, ZipArchiveEntryWayfinder)>>,
    /// Numbers of bytes, uncompressed, and of nodes and attributes that may still be read of them.
    bytes: u64,
    nodes: usize,
}

impl<'b> Parts<'b> {
    pub(super) fn open(bytes: &'b [u8]) -> Result<Self, String> {
        let no_archive = |error: rawzip::Error| format!("it is no zip archive ({error})");
        let archive = ZipArchive::from_slice(bytes).map_err(no_archive)?;
        let mut found = HashMap::new();
        let mut entries = archive.entries();
        while let Some(entry) = entries.next_entry().map_err(no_archive)? {
            let name = String::from_utf8_lossy(entry.file_path().as_ref()).into_owned();
            if found.len() == PARTS_MAX {
                return Err(format!("its archive has more than {PARTS_MAX} files"));
            }
            if found.contains_key(&name) {
                return Err(format!("its archive has two files `{}`", truncated(&name)));
            }
            found.insert(name, Some((entry.compression_method(), entry.wayfinder())));
        }
        Ok(Self {
            archive,
            entries: found,
            bytes: MOST_BYTES,
            nodes: NODES_MAX,
        })
    }

    /// Reads a file of XML, as [`xml::read`] does.
    pub(super) fn read(
        &mut self,
        name: &str,
        each: &mut dyn FnMut(&str, Piece<'_>) -> Result<(), String>,
    ) -> Result<(), String> {
        let shown = truncated(name);
        let entry = self.entries.get_mut(name);
        let entry = entry.ok_or_else(|| format!("its archive has no `{shown}`"))?;
        let (method, place) = entry
            .take()
            .ok_or_else(|| format!("several of its sheets are `{shown}`"))?;
        let entry = self.archive.get_entry(place);
        let entry = entry.map_err(|error| format!("`{shown}` of its archive: {error}"))?;
        let stored: Box<dyn Read> = match method {
            CompressionMethod::STORE => Box::new(entry.verifying_reader(entry.data())),
            CompressionMethod::DEFLATE => Box::new(entry.verifying_reader(DeflateDecoder::new(entry.data()))),
            _ => return Err(format!("`{shown}` is compressed otherwise than by deflate")),
        };
        let mut stored = BufReader::new(stored.take(self.bytes));
        let read = xml::read(&shown, &mut stored, &mut self.nodes, each);
        self.bytes = stored.get_ref().limit();
        match self.bytes {
            0 => Err(too_large("XML", MOST_BYTES)),
            _ => read,
        }
    }

    /// Whether there is a file of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.contains_key(name)
    }

    /// Reads a file of XML if there is one of this name.
    pub(super) fn read_optional(
        &mut self,
        name: &str,
        each: &mut dyn FnMut(&str, Piece<'_>) -> Result<(), String>,
    ) -> Result<(), String> {
        match self.has(name) {
            true => self.read(name, each),
            false => Ok(()),
        }
    }
}
