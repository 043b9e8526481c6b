//! Checksums (BLAKE3) that detect changed and damaged files.
//!
//! A checksummed file is its contents followed by a hash. The hash of a small file is taken over a context
//! and the contents; the context names the conditions under which the contents are valid, such as a build of
//! the program, and is not written. The hash of a large file is taken over the hashes of its pieces, which
//! several ranks compute together.

use std::io::{ErrorKind, Read, Seek, SeekFrom};

use blake3::{Hash, Hasher, OUT_LEN};
use slipfront::Communicator;

use crate::agree::agree_on_io;

/// Bytes of a piece; the last piece may be shorter.
const PIECE: u64 = 4 << 20;

/// Number of pieces with hashes in memory at the same time, which take 2 MiB.
const PIECES_AT_ONCE: u64 = 1 << 16;

/// The hash of the hashes of all pieces of the first `length` bytes of a file; every rank reads its share.
///
/// # Errors
/// When one of the ranks cannot read its share.
pub fn hash_of_pieces(
    file: &mut (impl Read + Seek),
    length: u64,
    communicator: &dyn Communicator,
) -> std::io::Result<Hash> {
    let (rank, ranks) = (communicator.rank() as u64, communicator.size() as u64);
    let n_pieces = length.div_ceil(PIECE);
    let mut hasher = Hasher::new();
    for first in (0..n_pieces).step_by(PIECES_AT_ONCE as usize) {
        let n = PIECES_AT_ONCE.min(n_pieces - first);
        // Hashes of other ranks are zero here, so that the sum over the ranks has all hashes.
        let mut words = vec![[0; OUT_LEN / size_of::<i64>()]; n as usize];
        let mut hash_own = || {
            for piece in n * rank / ranks..n * (rank + 1) / ranks {
                let begin = (first + piece) * PIECE;
                let hash = hash_range(file, begin, PIECE.min(length - begin))?;
                let (bytes, _) = hash.as_bytes().as_chunks();
                for (word, bytes) in words[piece as usize].iter_mut().zip(bytes) {
                    *word = i64::from_le_bytes(*bytes);
                }
            }
            Ok(())
        };
        agree_on_io(communicator, hash_own())?;
        communicator.sum(words.as_flattened_mut());
        for word in words.as_flattened() {
            hasher.update(&word.to_le_bytes());
        }
    }
    Ok(hasher.finalize())
}

/// Hash of a part of a file.
fn hash_range(file: &mut (impl Read + Seek), begin: u64, length: u64) -> std::io::Result<Hash> {
    file.seek(SeekFrom::Start(begin))?;
    let mut hasher = Hasher::new();
    hasher.update_reader(file.take(length))?;
    if hasher.count() < length {
        return Err(ErrorKind::UnexpectedEof.into());
    }
    Ok(hasher.finalize())
}

/// Contents with their checksum.
pub fn with_checksum(context: &[u8], contents: &[u8]) -> Vec<u8> {
    [contents, hash(context, contents).as_bytes()].concat()
}

/// The contents of a checksummed file; none if the checksum is wrong.
pub fn verified<'f>(context: &[u8], file: &'f [u8]) -> Option<&'f [u8]> {
    let (contents, checksum) = file.split_at_checked(file.len().checked_sub(OUT_LEN)?)?;
    (hash(context, contents).as_bytes() == checksum).then_some(contents)
}

fn hash(context: &[u8], contents: &[u8]) -> Hash {
    Hasher::new().update(context).update(contents).finalize()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use slipfront::communicator::Alone;
    use slipfront::testing::Threads;

    use super::*;

    #[test]
    fn a_small_file_is_verified_as_it_was_written() {
        let file = with_checksum(b"", b"contents");
        assert_eq!(verified(b"", &file), Some(&b"contents"[..]));
        assert_eq!(verified(b"another context", &file), None);
        for cut in 0..file.len() {
            assert_eq!(verified(b"", &file[..cut]), None, "{cut}");
        }
        for place in 0..file.len() {
            let mut flipped = file.clone();
            flipped[place] ^= 1;
            assert_eq!(verified(b"", &flipped), None, "{place}");
        }
    }

    /// Any number of ranks computes the hash of the hashes of the pieces, for files that end at, before and
    /// after the end of a piece.
    #[test]
    fn any_number_of_ranks_finds_the_same_hash_of_pieces() {
        let piece = PIECE as usize;
        let file: Vec<u8> = (0..3 * piece).map(|byte| (byte % 251) as u8).collect();
        for length in [0, 1, piece - 1, piece, piece + 1, 2 * piece + 5, 3 * piece] {
            let pieces = file[..length].chunks(piece);
            let hashes: Vec<u8> = pieces.flat_map(|piece| *blake3::hash(piece).as_bytes()).collect();
            for ranks in [1, 2, 3, 7] {
                let found = Threads::run(ranks, |communicator| {
                    hash_of_pieces(&mut Cursor::new(&file), length as u64, communicator).unwrap()
                });
                assert_eq!(found, vec![blake3::hash(&hashes); ranks], "{length} {ranks}");
            }
        }
        let longer = hash_of_pieces(&mut Cursor::new(&file), file.len() as u64 + 1, &Alone);
        assert_eq!(longer.unwrap_err().kind(), ErrorKind::UnexpectedEof);
    }
}
