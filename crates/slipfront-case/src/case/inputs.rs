//! Files that a case reads.

use std::collections::HashMap;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use blake3::Hasher;
use slipfront::{Communicator, Lattice, Scales};

use super::files::{Files, OpenFile, Watch, Watched, open_in_memory};
use super::ranks::Ranks;
use crate::arrays::{self, ArrayError, Slab};
use crate::case_file::{CaseError, CaseFile, FileUse};
use crate::same_on_ranks::{NamedInputs, expect_same, of_all, words_of};
use slipfront_base::disk::open_regular;
use slipfront_base::machine::machine_number;
use slipfront_base::text::{display_path, single_line};

/// A file that a case reads. The run folder contains a copy of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Path of the copy in the run folder.
    pub name: String,
    /// Path from which the file is read, or its name if it is in memory.
    pub original: PathBuf,
    /// Contents of the file, if they are in memory.
    pub contents: Option<Arc<[u8]>>,
    /// Length of the file in bytes.
    pub length: u64,
    /// Hash of the file's contents, taken before the case was made from them. A later copy with this hash has
    /// the contents that the case was made from.
    pub hash: blake3::Hash,
}

impl Input {
    /// Contents of the file, read again unless they are in memory.
    ///
    /// # Errors
    /// When the file cannot be read, or has changed since the case was made from it.
    pub fn read_again(&self) -> Result<Arc<[u8]>, CaseError> {
        if let Some(contents) = &self.contents {
            return Ok(Arc::clone(contents));
        }
        let path = self.original.display();
        let mut contents = Vec::new();
        let read = self.open().and_then(|mut file| file.read_to_end(&mut contents));
        read.map_err(|error| {
            let sentence = format!("{path}, which the case reads, cannot be read again: {error}");
            CaseError::invalid(None, sentence)
        })?;
        if blake3::hash(&contents) != self.hash {
            let sentence = format!("{path} has changed since the case was prepared: load the case again");
            return Err(CaseError::invalid(None, sentence));
        }
        Ok(contents.into())
    }

    /// Opens the file for copying.
    ///
    /// # Errors
    /// When the file is on the disk and is not a readable regular file.
    pub fn open(&self) -> io::Result<OpenFile> {
        match &self.contents {
            Some(contents) => Ok(open_in_memory(contents)),
            None => Ok(Box::new(open_regular(&self.original)?)),
        }
    }
}

/// Chooses the name of a file's copy in the folder `inputs/`, after its plain name; files with the same name
/// and different contents are numbered. Returns the name, and whether this copy already exists.
///
/// `is_same` returns, for a name, whether the existing copy has the contents of the file; none if there is no
/// copy.
pub fn name_of_copy(plain: &str, is_same: impl Fn(&str) -> Option<bool>) -> (String, bool) {
    let mut name = format!("inputs/{plain}");
    let mut number = 1;
    while let Some(is_same) = is_same(&name) {
        if is_same {
            return (name, true);
        }
        number += 1;
        name = format!("inputs/{number}-{plain}");
    }
    (name, false)
}

/// Length and hash of a file.
type Digest = (u64, blake3::Hash);

/// A file that a case names.
struct FoundFile {
    key: String,
    holds: FileUse,
    original: PathBuf,
    /// Contents of the file and their hash, if they are in memory.
    contents: Option<(Arc<[u8]>, blake3::Hash)>,
    /// Stamp that changes when the file changes or is replaced.
    stamp: String,
}

/// Files that a case names, before any of them is read.
pub(super) struct NamedFiles(Vec<FoundFile>);

impl NamedFiles {
    /// Finds the files without opening any.
    pub(super) fn find(file: &mut CaseFile, files: Files) -> Result<Self, CaseError> {
        let (named, source) = file.files_mut();
        let found = named.map(|named| {
            let contents = files.in_memory.and_then(|in_memory| in_memory.get(&*named.name));
            let contents = contents.map(|contents| (Arc::clone(contents), blake3::hash(contents)));
            let (original, stamp) = match &contents {
                Some((_, hash)) => (PathBuf::from(&*named.name), Ok(hash.to_string())),
                None => {
                    let original = files.folder.join(&*named.name);
                    let stamp = stamp(&original);
                    (original, stamp)
                }
            };
            Ok(FoundFile {
                stamp: stamp.map_err(|error| source.error(&named.key, error.to_string()))?,
                key: named.key,
                holds: named.holds,
                original,
                contents,
            })
        });
        found.collect::<Result<_, _>>().map(Self)
    }

    /// Hashes the files, and replaces their names in the case by the names of copies. Files with the same
    /// name and contents share one copy.
    ///
    /// Among ranks that find the same files, such as those of one machine, only one hashes them.
    ///
    /// # Errors
    /// When ranks find different files, when a file cannot be read, or when `watch` ends the work.
    pub(super) fn read(
        &self,
        file: &mut CaseFile,
        lattice: &Lattice,
        watch: &mut Watch,
        ranks: &Ranks,
    ) -> Result<Vec<Input>, CaseError> {
        if self.0.is_empty() {
            return Ok(Vec::new());
        }
        let communicator = ranks.communicator;
        let stamps = self.0.iter().map(|found| found.stamp.as_str());
        let seen = format!("{} {}", machine_number(), stamps.collect::<String>());
        let seen = of_all(communicator, words_of(&blake3::hash(seen.as_bytes()))[0]);
        let reader = seen.iter().position(|other| *other == seen[communicator.rank()]);
        let own = if reader == Some(communicator.rank()) {
            self.hash(file, lattice, watch).map(Some)
        } else {
            Ok(None)
        };
        let own = ranks.agree(own)?;
        let digests = self.of_first(own.as_deref(), communicator);
        // Ranks that have not hashed the files rely on another rank that finds the same files.
        let given = own.as_ref().unwrap_or(&digests);
        expect_same(communicator, || self.given(given))?;
        Ok(self.name_copies(file, &digests))
    }

    /// Length and hash of each file.
    fn hash(&self, file: &CaseFile, lattice: &Lattice, watch: &mut Watch) -> Result<Vec<Digest>, CaseError> {
        let mut known: HashMap<&Path, Digest> = HashMap::new();
        let digests = self.0.iter().map(|found| {
            let original = &found.original;
            if let Some(digest) = known.get(&**original) {
                return Ok(*digest);
            }
            let contents = found.contents.as_ref();
            let opened = open(
                original,
                contents.map(|(contents, _)| contents),
                found.holds,
                lattice,
            );
            let digest = opened.and_then(|opened| match contents {
                Some((contents, hash)) => Ok((contents.len() as u64, *hash)),
                None => read_watched(opened, watch, |source| digest(original, source)),
            });
            let digest = digest.map_err(|error| placed(file, &found.key, error))?;
            known.insert(original, digest);
            Ok(digest)
        });
        digests.collect()
    }

    /// Digests of each file that rank 0 has found.
    fn of_first(&self, own: Option<&[Digest]>, communicator: &dyn Communicator) -> Vec<Digest> {
        let mut words = vec![[0; 5]; self.0.len()];
        if communicator.rank() == 0 {
            for (words, (length, hash)) in words.iter_mut().zip(own.into_iter().flatten()) {
                words[0] = length.cast_signed();
                words[1..].copy_from_slice(&words_of(hash));
            }
        }
        communicator.sum(words.as_flattened_mut());
        let digest = |[length, hash @ ..]: [i64; 5]| (length.cast_unsigned(), hash_of_words(hash));
        words.into_iter().map(digest).collect()
    }

    /// Names and contents of the files, for the comparison between ranks.
    fn given(&self, digests: &[Digest]) -> NamedInputs {
        let named = self.0.iter().zip(digests).map(|(found, (length, hash))| {
            let name = format!("{} (`{}`)", single_line(&found.plain_name()), found.key);
            let contents = format!("a file of {length} bytes with the hash {hash}");
            (name, contents)
        });
        named.collect()
    }

    fn name_copies(&self, file: &mut CaseFile, digests: &[Digest]) -> Vec<Input> {
        let mut inputs: Vec<Input> = Vec::new();
        let names = file.files_mut().0.map(|named| named.name);
        for ((found, (length, hash)), written) in self.0.iter().zip(digests).zip(names) {
            let is_same = |name: &str| Some(inputs.iter().find(|input| input.name == name)?.hash == *hash);
            let (name, is_kept) = name_of_copy(&found.plain_name(), is_same);
            written.clone_from(&name);
            if !is_kept {
                inputs.push(Input {
                    name,
                    original: found.original.clone(),
                    contents: found.contents.as_ref().map(|(contents, _)| Arc::clone(contents)),
                    length: *length,
                    hash: *hash,
                });
            }
        }
        inputs
    }

    /// Refuses a file that has changed since it was found: its contents as read may differ from the hashed
    /// ones.
    pub(super) fn expect_unchanged(&self, file: &CaseFile) -> Result<(), CaseError> {
        for found in self.0.iter().filter(|found| found.contents.is_none()) {
            let now = stamp(&found.original).map_err(|error| placed(file, &found.key, error))?;
            if now != found.stamp {
                let sentence = format!(
                    "{} was changed while the case was prepared: start again, and do not change this file meanwhile",
                    display_path(&found.original)
                );
                return Err(file.source.error(&found.key, sentence));
            }
        }
        Ok(())
    }
}

impl FoundFile {
    fn plain_name(&self) -> String {
        let plain = self.original.file_name();
        plain.map_or_else(|| "input".to_owned(), |name| name.to_string_lossy().into_owned())
    }
}

/// Stamp of a file: its identity on this machine, and the time of its last change.
fn stamp(path: &Path) -> Result<String, ArrayError> {
    let metadata = path.metadata().map_err(ArrayError::read(path))?;
    #[cfg(unix)]
    let identity = {
        use std::os::unix::fs::MetadataExt;
        (
            metadata.dev(),
            metadata.ino(),
            metadata.ctime(),
            metadata.ctime_nsec(),
        )
    };
    #[cfg(not(unix))]
    let identity = path.canonicalize().ok();
    Ok(format!(
        "{identity:?} {} {:?}",
        metadata.len(),
        metadata.modified().ok()
    ))
}

fn hash_of_words(words: [i64; 4]) -> blake3::Hash {
    let mut bytes = [0; blake3::OUT_LEN];
    for (bytes, word) in bytes.chunks_exact_mut(8).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    blake3::Hash::from_bytes(bytes)
}

/// Opens a file in memory or on the disk, and limits its length to what its use on this lattice requires.
/// Returns the file and its length.
fn open(
    original: &Path,
    contents: Option<&Arc<[u8]>>,
    holds: FileUse,
    &Lattice { nx, ny, .. }: &Lattice,
) -> Result<(OpenFile, u64), ArrayError> {
    let (opened, length): (OpenFile, u64) = match contents {
        Some(contents) => (open_in_memory(contents), contents.len() as u64),
        None => {
            let (file, length) = arrays::open(original)?;
            (Box::new(file), length)
        }
    };
    match holds {
        FileUse::Numbers | FileUse::Blocks => arrays::limit_length(original, length, nx, ny)?,
        FileUse::HeightMap => arrays::limit_length_of_height_map(original, length)?,
        FileUse::Drawing => arrays::limit_length_of_drawing(original, length)?,
        FileUse::State => arrays::limit_length(original, length, nx, 4 * ny)?,
    }
    Ok((opened, length))
}

/// Reads a file of this length with `read`, until `watch` stops it.
fn read_watched<T>(
    (file, length): (OpenFile, u64),
    watch: &mut Watch,
    read: impl FnOnce(&mut BufReader<Watched>) -> Result<T, ArrayError>,
) -> Result<T, ArrayError> {
    let mut source = BufReader::new(Watched::new(file, length, watch));
    let read = read(&mut source);
    // Each format reports a refused read as a different error.
    if source.get_ref().is_stopped {
        return Err(ArrayError::Stopped);
    }
    read
}

fn digest(path: &Path, source: impl Read) -> Result<Digest, ArrayError> {
    let mut hasher = Hasher::new();
    hasher.update_reader(source).map_err(ArrayError::read(path))?;
    Ok((hasher.count(), hasher.finalize()))
}

/// A case file with its units and lattice, and the files that it names, of which some rows are read.
pub(super) struct Inputs<'a, 'w> {
    pub(super) file: &'a CaseFile,
    pub(super) scales: &'a Scales,
    pub(super) lattice: &'a Lattice,
    pub(super) files: &'a [Input],
    pub(super) slab: Slab,
    pub(super) watch: &'a mut Watch<'w>,
}

impl Inputs<'_, '_> {
    /// Reads the input file with this name in the case, given by `key`, for the use `holds`.
    pub(super) fn read<T>(
        &mut self,
        key: &str,
        name: &str,
        holds: FileUse,
        read: impl FnOnce(&Path, &mut BufReader<Watched>) -> Result<T, ArrayError>,
    ) -> Result<T, CaseError> {
        let input = self.files.iter().find(|input| input.name == name);
        let original = input.map_or(Path::new(name), |input| &input.original);
        let contents = input.and_then(|input| input.contents.as_ref());
        let opened = open(original, contents, holds, self.lattice);
        let read =
            opened.and_then(|opened| read_watched(opened, self.watch, |source| read(original, source)));
        read.map_err(|error| placed(self.file, key, error))
    }

    /// Reads the image or array with this name in the case, given by `key`: whether each block of the slab is
    /// dark, or 1.
    pub(super) fn read_mask(
        &mut self,
        key: &str,
        name: &str,
        threshold: f64,
        slab: &Slab,
    ) -> Result<Vec<bool>, CaseError> {
        self.read(key, name, FileUse::Blocks, |path, source| {
            if is_array(path) {
                arrays::mask_npy(path, source, slab)
            } else {
                arrays::mask_png(path, source, threshold, slab)
            }
        })
    }

    /// Reads one number per block from the file with this name, if the case names one.
    pub(super) fn read_field(
        &mut self,
        key: &str,
        name: &Option<String>,
    ) -> Result<Option<Vec<f64>>, CaseError> {
        let slab = self.slab.clone();
        let read = |path: &Path, source: &mut BufReader<Watched>| arrays::field(path, source, &slab);
        let name = name.as_ref();
        name.map(|name| self.read(key, name, FileUse::Blocks, read))
            .transpose()
    }

    /// Reads one number per block, of any sign, from the file with this name, if the case names one.
    pub(super) fn read_signed_field(
        &mut self,
        key: &str,
        name: &Option<String>,
    ) -> Result<Option<Vec<f64>>, CaseError> {
        let slab = self.slab.clone();
        let read = |path: &Path, source: &mut BufReader<Watched>| arrays::signed_field(path, source, &slab);
        let name = name.as_ref();
        name.map(|name| self.read(key, name, FileUse::Blocks, read))
            .transpose()
    }
}

/// Whether the file of a mask is an array, not an image.
pub(super) fn is_array(path: &Path) -> bool {
    arrays::extension(path) == "npy"
}

/// An error about the file that a key names.
fn placed(file: &CaseFile, key: &str, error: ArrayError) -> CaseError {
    match error {
        ArrayError::Stopped => CaseError::Stopped,
        error => file.source.error(key, error.to_string()),
    }
}
