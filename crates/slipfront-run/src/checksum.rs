//! Checksums (BLAKE3), by which changed and damaged files are noticed.
//!
//! A checksummed file is its contents followed by the hash of a context and of the contents. The context is what the
//! contents are valid for, such as a build of the program; it is not written.

use std::io::{Read, Write};

use blake3::{Hash, Hasher, OUT_LEN};

/// A writer that hashes what is written through it.
#[derive(Debug)]
pub struct HashingWriter<W> {
    inner: W,
    hasher: Hasher,
}

impl<W: Write> HashingWriter<W> {
    /// Nothing written yet.
    pub fn new(inner: W) -> Self {
        let hasher = Hasher::new();
        Self { inner, hasher }
    }

    /// Writes the checksum of all that was written.
    pub fn finish(mut self) -> std::io::Result<()> {
        self.inner.write_all(self.hasher.finalize().as_bytes())
    }
}

impl<W: Write> Write for HashingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.inner.flush()
    }
}

/// The number of bytes before the checksum of a file of `length` bytes, read from its start; none if the checksum does
/// not fit.
pub fn verify_reader(mut reader: impl Read, length: u64) -> std::io::Result<Option<u64>> {
    let Some(contents) = length.checked_sub(OUT_LEN as u64) else {
        return Ok(None);
    };
    let mut hasher = Hasher::new();
    hasher.update_reader(reader.by_ref().take(contents))?;
    let mut checksum = Vec::new();
    reader.read_to_end(&mut checksum)?;
    Ok((hasher.finalize().as_bytes() == checksum.as_slice()).then_some(contents))
}

/// Contents with their checksum.
pub fn with_checksum(context: &[u8], contents: &[u8]) -> Vec<u8> {
    [contents, hash(context, contents).as_bytes()].concat()
}

/// The contents of a checksummed file; none if the checksum does not fit.
pub fn verified<'f>(context: &[u8], file: &'f [u8]) -> Option<&'f [u8]> {
    let (contents, checksum) = file.split_at_checked(file.len().checked_sub(OUT_LEN)?)?;
    (hash(context, contents).as_bytes() == checksum).then_some(contents)
}

fn hash(context: &[u8], contents: &[u8]) -> Hash {
    Hasher::new().update(context).update(contents).finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_write_and_verify_one_layout() {
        let mut file = Vec::new();
        let mut writer = HashingWriter::new(&mut file);
        writer.write_all(b"contents").unwrap();
        writer.finish().unwrap();
        assert_eq!(file, with_checksum(b"", b"contents"));
        assert_eq!(verified(b"", &file), Some(&b"contents"[..]));
        assert_eq!(verified(b"another context", &file), None);
        assert_eq!(verify_reader(&file[..], file.len() as u64).unwrap(), Some(8));
        for cut in 0..file.len() {
            assert_eq!(verified(b"", &file[..cut]), None, "{cut}");
            assert_eq!(verify_reader(&file[..cut], cut as u64).unwrap(), None, "{cut}");
        }
        for place in 0..file.len() {
            let mut flipped = file.clone();
            flipped[place] ^= 1;
            assert_eq!(verified(b"", &flipped), None, "{place}");
        }
    }
}
